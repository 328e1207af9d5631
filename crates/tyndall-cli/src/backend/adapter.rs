//! Adapters: what they say of themselves.

/// An adapter's description of itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterDescription {
    /// The adapter's name.
    pub name: String,
    /// The driver and its version.
    pub driver: String,
    /// The graphics interface.
    pub api: &'static str,
}

impl AdapterDescription {
    /// Asks an adapter.
    pub fn of(adapter: &wgpu::Adapter) -> Self {
        let info = adapter.get_info();
        let driver = format!("{} {}", info.driver, info.driver_info);
        Self {
            name: info.name,
            driver: driver.trim().to_owned(),
            api: info.backend.to_str(),
        }
    }
}
