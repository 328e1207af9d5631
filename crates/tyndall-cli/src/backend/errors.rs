//! Errors that a device reports outside any call's result.

use std::sync::{Arc, Mutex, PoisonError};

use wgpu::Device;

use crate::failure::Failure;

/// The first error that the device reports outside any call's result.
pub(crate) struct DeviceErrors(Arc<Mutex<Option<String>>>);

impl DeviceErrors {
    /// Watches from now on; nobody else does from then on.
    pub(crate) fn watch(device: &Device) -> Self {
        let first = Arc::new(Mutex::new(None));
        let slot = Arc::clone(&first);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            let mut slot = slot.lock().unwrap_or_else(PoisonError::into_inner);
            slot.get_or_insert_with(|| error.to_string());
        }));
        Self(first)
    }

    /// The error that was reported, which is why the result failed if it did; the result where there is none.
    pub(crate) fn else_result<T>(&self, result: Result<T, Failure>) -> Result<T, Failure> {
        match &*self.0.lock().unwrap_or_else(PoisonError::into_inner) {
            Some(message) => Err(Failure::Device(anyhow::anyhow!(
                "the device failed: {message}"
            ))),
            None => result,
        }
    }
}
