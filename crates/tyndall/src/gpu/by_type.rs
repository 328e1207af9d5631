//! One value of each type, created when it is first asked for and shared by all that ask.

use std::{
    any::{Any, TypeId},
    collections::HashMap,
    sync::{Arc, Mutex, PoisonError},
};

/// In the browser, the GPU's objects stay on their thread.
#[cfg(target_arch = "wasm32")]
type AnyHeld = dyn Any;
#[cfg(not(target_arch = "wasm32"))]
type AnyHeld = dyn Any + Send + Sync;

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

/// Values by their types.
#[derive(Default)]
pub(crate) struct ByType {
    /// Each an `Arc` of the type.
    made: Mutex<HashMap<TypeId, Box<AnyHeld>>>,
}

impl ByType {
    /// The value of this type, which `make` creates if nobody has asked for it yet.
    pub(crate) fn get<T: Held>(&self, make: impl FnOnce() -> T) -> Arc<T> {
        if let Some(found) = self.find() {
            return found;
        }
        // Unlocked, for what is made may ask for others.
        let made = Arc::new(make());
        let mut all = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        all.insert(TypeId::of::<T>(), Box::new(Arc::clone(&made)));
        made
    }

    fn find<T: Held>(&self) -> Option<Arc<T>> {
        let all = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        let found = all.get(&TypeId::of::<T>())?;
        found.downcast_ref::<Arc<T>>().map(Arc::clone)
    }
}
