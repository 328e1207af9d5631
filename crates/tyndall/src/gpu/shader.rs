//! Shaders of the package on a device, each made once an effect.

use std::{
    collections::HashMap,
    sync::{Arc, Mutex, PoisonError},
};

use crate::shader::Reflection;

/// A shader on the device, and what it says of itself.
pub(crate) struct Shader {
    pub(crate) module: wgpu::ShaderModule,
    pub(crate) reflection: Reflection,
}

/// The shaders of an effect by the path of their module in the package, without the package's name.
#[derive(Default)]
pub(crate) struct Shaders(Mutex<HashMap<&'static str, Arc<Shader>>>);

impl Shaders {
    /// The shader of this path.
    ///
    /// # Panics
    /// Where the package has no such module, or it is no valid shader: tests link all of them.
    pub(crate) fn get(&self, device: &wgpu::Device, path: &'static str) -> Arc<Shader> {
        let mut made = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let make = || {
            let reflection = Reflection::new(&format!("tyndall::{path}"));
            let reflection = reflection.expect("a valid shader of the package");
            let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(path),
                source: wgpu::ShaderSource::Wgsl((&*reflection.linked.wgsl).into()),
            });
            Arc::new(Shader { module, reflection })
        };
        Arc::clone(made.entry(path).or_insert_with(make))
    }
}
