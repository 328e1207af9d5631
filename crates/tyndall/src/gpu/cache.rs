//! Programs by their type, created when they are first asked for and shared by all that ask.

use std::{
    any::{Any, TypeId},
    collections::HashMap,
    sync::{Arc, Mutex, PoisonError},
};

use super::scope::Shared;

/// Programs that belong together: those of a technique, or of passes that several techniques use.
pub(crate) trait Programs: Held {
    fn new(device: &wgpu::Device, shared: &Shared) -> Self;
}

/// In the browser, the GPU's objects stay on their thread.
#[cfg(target_arch = "wasm32")]
type Any_ = dyn Any;
#[cfg(not(target_arch = "wasm32"))]
type Any_ = dyn Any + Send + Sync;

/// Anything that the cache can hold.
#[cfg(target_arch = "wasm32")]
pub(crate) trait Held: Any {}
#[cfg(target_arch = "wasm32")]
impl<T: Any> Held for T {}
/// Anything that the cache can hold.
#[cfg(not(target_arch = "wasm32"))]
pub(crate) trait Held: Any + Send + Sync {}
#[cfg(not(target_arch = "wasm32"))]
impl<T: Any + Send + Sync> Held for T {}

#[derive(Default)]
pub(crate) struct ProgramCache {
    /// Each an `Arc` of the type.
    made: Mutex<HashMap<TypeId, Box<Any_>>>,
}

impl ProgramCache {
    /// Those of this type, which `make` creates if nobody has asked for them yet.
    pub(crate) fn get<P: Held>(&self, make: impl FnOnce() -> P) -> Arc<P> {
        if let Some(found) = self.find() {
            return found;
        }
        // Unlocked, for programs may ask for others.
        let made = Arc::new(make());
        let mut all = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        all.insert(TypeId::of::<P>(), Box::new(Arc::clone(&made)));
        made
    }

    fn find<P: Held>(&self) -> Option<Arc<P>> {
        let all = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        let found = all.get(&TypeId::of::<P>())?;
        found.downcast_ref::<Arc<P>>().map(Arc::clone)
    }
}
