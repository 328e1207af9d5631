//! Structs that stand in Rust and in WGSL.

/// Declares a plain struct whose WGSL twin is `$wgsl` of the module `$module`, and a test that both are laid out alike.
/// Fields whose names begin with `pad` are padding.
macro_rules! block {
    (
        $(#[$meta:meta])*
        $vis:vis struct $name:ident = $wgsl:literal in $module:literal, checked by $test:ident {
            $($(#[$field_meta:meta])* $field_vis:vis $field:ident: $ty:ty),+ $(,)?
        }
    ) => {
        $(#[$meta])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
        $vis struct $name {
            $($(#[$field_meta])* $field_vis $field: $ty),+
        }

        #[cfg(test)]
        #[test]
        fn $test() {
            let fields = [$((stringify!($field), std::mem::offset_of!($name, $field))),+];
            $crate::shader::tests::check_layout($module, $wgsl, &fields, size_of::<$name>());
        }
    };
}
pub(crate) use block;
