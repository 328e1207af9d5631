//! What a linked shader says of itself: its bindings, workgroup sizes and overrides, read by naga.

use std::{collections::HashSet, num::NonZeroU64};

use naga::{
    AddressSpace, GlobalVariable, Handle, ImageClass, ImageDimension, ScalarKind, StorageAccess,
    TypeInner,
    valid::{Capabilities, ModuleInfo, ValidationFlags, Validator},
};

use super::link::{LinkError, Linked, Linker};

/// A shader of the package.
pub(crate) struct Reflection {
    pub(crate) linked: Linked,
    module: naga::Module,
    info: ModuleInfo,
}

impl Reflection {
    /// Links and reads the module of this path.
    ///
    /// # Errors
    /// What is wrong with it, in words, with the module's path and line.
    pub(crate) fn new(root: &str) -> Result<Self, String> {
        Self::of(Linker::new().link(root), ValidationFlags::empty())
    }

    pub(super) fn of(
        linked: Result<Linked, LinkError>,
        flags: ValidationFlags,
    ) -> Result<Self, String> {
        let linked = linked.map_err(|error| error.to_string())?;
        let at = |line: Option<u32>| {
            let origin = line.and_then(|line| linked.origin(line as usize));
            origin.map_or_else(String::new, |(path, line)| format!("{path}:{line}: "))
        };
        let module = naga::front::wgsl::parse_str(&linked.wgsl).map_err(|error| {
            let line = error.location(&linked.wgsl).map(|l| l.line_number);
            format!("{}{}", at(line), error.message())
        })?;
        let mut validator = Validator::new(flags, Capabilities::all());
        let info = validator.validate(&module).map_err(|error| {
            let line = error.location(&linked.wgsl).map(|l| l.line_number);
            let text = error.emit_to_string(&linked.wgsl);
            format!("{}{text}", at(line))
        })?;
        Ok(Self {
            linked,
            module,
            info,
        })
    }

    #[cfg(test)]
    pub(super) fn naga(&self) -> (&naga::Module, &ModuleInfo) {
        (&self.module, &self.info)
    }

    /// True where the shader declares an override of this name.
    pub(crate) fn has_override(&self, name: &str) -> bool {
        let named = |o: &naga::Override| o.name.as_deref() == Some(name);
        self.module.overrides.iter().any(|(_, o)| named(o))
    }

    /// Invocations of a workgroup of a compute entry point, in x, y and z; `None` where there is no such entry point.
    pub(crate) fn workgroup_size(&self, entry_point: &str) -> Option<[u32; 3]> {
        let (_, found) = self.entry_points().find(|(_, e)| e.name == entry_point)?;
        Some(found.workgroup_size)
    }

    /// The layout entries of a bind group, by binding: what these entry points read.
    pub(crate) fn bindings_of(
        &self,
        group: u32,
        entry_points: &[&str],
    ) -> Vec<wgpu::BindGroupLayoutEntry> {
        let functions: Vec<_> = self
            .entry_points()
            .filter(|(_, entry)| entry_points.contains(&entry.name.as_str()))
            .map(|(index, _)| self.info.get_entry_point(index))
            .collect();
        let is_used =
            |global: Handle<GlobalVariable>| functions.iter().any(|f| !f[global].is_empty());
        self.bindings(group, is_used)
    }

    /// The layout entries of a bind group, by binding: all that the shader declares.
    pub(crate) fn bindings_declared(&self, group: u32) -> Vec<wgpu::BindGroupLayoutEntry> {
        self.bindings(group, |_| true)
    }

    fn entry_points(&self) -> impl Iterator<Item = (usize, &naga::EntryPoint)> {
        self.module.entry_points.iter().enumerate()
    }

    fn bindings(
        &self,
        group: u32,
        is_used: impl Fn(Handle<GlobalVariable>) -> bool,
    ) -> Vec<wgpu::BindGroupLayoutEntry> {
        let sampled = self.sampled();
        let entry = |(handle, global): (Handle<GlobalVariable>, &GlobalVariable)| {
            let binding = global.binding.as_ref().filter(|b| b.group == group)?;
            let ty = self.binding_type(global, sampled.contains(&handle))?;
            is_used(handle).then_some(wgpu::BindGroupLayoutEntry {
                binding: binding.binding,
                visibility: visibility(&ty),
                ty,
                count: None,
            })
        };
        let globals = self.module.global_variables.iter();
        let mut entries: Vec<_> = globals.filter_map(entry).collect();
        entries.sort_by_key(|entry| entry.binding);
        entries
    }

    /// The textures that any function samples: they must be filterable.
    fn sampled(&self) -> HashSet<Handle<GlobalVariable>> {
        let functions = self.module.functions.iter().map(|(f, _)| &self.info[f]);
        let entry_points = self
            .entry_points()
            .map(|(i, _)| self.info.get_entry_point(i));
        functions
            .chain(entry_points)
            .flat_map(|info| info.sampling_set.iter().map(|key| key.image))
            .collect()
    }

    fn binding_type(&self, global: &GlobalVariable, sampled: bool) -> Option<wgpu::BindingType> {
        let ty = &self.module.types[global.ty].inner;
        let buffer = |ty, min_binding_size| wgpu::BindingType::Buffer {
            ty,
            has_dynamic_offset: false,
            min_binding_size,
        };
        Some(match (global.space, ty) {
            (AddressSpace::Uniform, _) => buffer(
                wgpu::BufferBindingType::Uniform,
                NonZeroU64::new(ty.size(self.module.to_ctx()).into()),
            ),
            (AddressSpace::Storage { access }, _) => {
                let read_only = !access.contains(StorageAccess::STORE);
                buffer(wgpu::BufferBindingType::Storage { read_only }, None)
            }
            (AddressSpace::Handle, TypeInner::Sampler { .. }) => {
                wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering)
            }
            (
                AddressSpace::Handle,
                TypeInner::Image {
                    dim,
                    arrayed,
                    class,
                },
            ) => image(*dim, *arrayed, *class, sampled)?,
            _ => return None,
        })
    }
}

/// All stages, but for what vertices may not see without a feature of their own.
fn visibility(ty: &wgpu::BindingType) -> wgpu::ShaderStages {
    let is_written = matches!(
        ty,
        wgpu::BindingType::StorageTexture { .. }
            | wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only: false },
                ..
            }
    );
    if is_written {
        wgpu::ShaderStages::FRAGMENT | wgpu::ShaderStages::COMPUTE
    } else {
        wgpu::ShaderStages::VERTEX_FRAGMENT | wgpu::ShaderStages::COMPUTE
    }
}

fn image(
    dim: ImageDimension,
    arrayed: bool,
    class: ImageClass,
    sampled: bool,
) -> Option<wgpu::BindingType> {
    let view_dimension = match (dim, arrayed) {
        (ImageDimension::D2, false) => wgpu::TextureViewDimension::D2,
        (ImageDimension::D2, true) => wgpu::TextureViewDimension::D2Array,
        // The package has none.
        _ => return None,
    };
    let texture = |sample_type, multisampled| wgpu::BindingType::Texture {
        sample_type,
        view_dimension,
        multisampled,
    };
    Some(match class {
        ImageClass::Depth { multi } => texture(wgpu::TextureSampleType::Depth, multi),
        ImageClass::Sampled { kind, multi } => {
            let sample_type = match kind {
                ScalarKind::Uint => wgpu::TextureSampleType::Uint,
                ScalarKind::Sint => wgpu::TextureSampleType::Sint,
                _ => wgpu::TextureSampleType::Float {
                    filterable: sampled,
                },
            };
            texture(sample_type, multi)
        }
        ImageClass::Storage { format, .. } => wgpu::BindingType::StorageTexture {
            access: wgpu::StorageTextureAccess::WriteOnly,
            format: storage_format(format)?,
            view_dimension,
        },
        ImageClass::External => return None,
    })
}

fn storage_format(format: naga::StorageFormat) -> Option<wgpu::TextureFormat> {
    Some(match format {
        naga::StorageFormat::Rgba32Float => wgpu::TextureFormat::Rgba32Float,
        naga::StorageFormat::Rgba16Float => wgpu::TextureFormat::Rgba16Float,
        naga::StorageFormat::R32Float => wgpu::TextureFormat::R32Float,
        naga::StorageFormat::R32Uint => wgpu::TextureFormat::R32Uint,
        // The package writes no others.
        _ => return None,
    })
}
