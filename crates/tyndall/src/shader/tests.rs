use std::collections::{BTreeSet, HashMap};

use naga::{
    back::{PipelineConstants, pipeline_constants::process_overrides},
    valid::{Capabilities, ValidationFlags, Validator},
};

use super::{
    LinkError, Linker, Reflection, constant, modules,
    scan::{code, declared, identifiers, split_imports},
};

/// Holds a Rust struct against its WGSL twin. Its fields are given with their offsets, padding among them.
pub(crate) fn check_layout(module: &str, wgsl: &str, fields: &[(&str, usize)], size: usize) {
    let linked = Linker::new().link(module).expect("the module links");
    let parsed = naga::front::wgsl::parse_str(&linked.wgsl).expect("the module parses");
    let named = |ty: &naga::Type| ty.name.as_deref() == Some(wgsl);
    let (_, found) = parsed
        .types
        .iter()
        .find(|(_, ty)| named(ty))
        .unwrap_or_else(|| panic!("{module} has no struct {wgsl}"));
    let naga::TypeInner::Struct { members, span } = &found.inner else {
        panic!("{wgsl} is not a struct");
    };
    let name = |member: &naga::StructMember| member.name.clone().unwrap_or_default();
    let theirs: Vec<_> = members
        .iter()
        .map(|member| (name(member), member.offset as usize))
        .collect();
    let ours: Vec<_> = fields
        .iter()
        .filter(|(name, _)| !name.starts_with("pad"))
        .map(|(name, offset)| ((*name).to_owned(), *offset))
        .collect();
    assert_eq!(theirs, ours, "{wgsl}");
    // A block may be padded to 16 bytes at its end.
    let padded = size.next_multiple_of(16);
    assert_eq!(padded, span.next_multiple_of(16) as usize, "{wgsl}");
}

/// Links a test's own text with what it imports, as the harness can run it: without a depth buffer, with other modules in
/// place of some, and with overrides fixed.
pub(crate) fn harness(text: &str, replaced: &[(&str, &str)], overrides: &[(&str, u32)]) -> String {
    const CHOICE: &str = "fn frame_choice(value: u32) -> u32 { return value; }";
    let linker = Linker::new()
        .module("test::main", text)
        .module("tyndall::gpu::choice", CHOICE);
    let linker = replaced
        .iter()
        .fold(linker, |linker, (path, text)| linker.module(*path, *text));
    let linked = linker.link("test::main").expect("the modules link").wgsl;
    overrides.iter().fold(linked, |linked, (name, value)| {
        let from = format!("{name}: u32 = 0u");
        assert!(linked.contains(&from), "{name}");
        linked.replace(&from, &format!("{name}: u32 = {value}u"))
    })
}

/// The same text with all bindings in group 0: binding 3 of group 1 is 13.
pub(crate) fn in_one_group(wgsl: &str) -> String {
    [1, 2].iter().fold(wgsl.to_owned(), |wgsl, group| {
        let from = format!("@group({group}) @binding(");
        wgsl.replace(&from, &format!("@group(0) @binding({group}"))
    })
}

/// The values of the overrides that lights and media choose: kind with texture, shadow map with glass, phase functions in
/// turn.
fn light_variants() -> Vec<Vec<(String, u32)>> {
    let lights = [(0, 0), (0, 1), (1, 0), (1, 3), (2, 0), (2, 2), (3, 0)];
    let shadows = [(0, 0), (1, 0), (1, 4), (2, 0), (2, 1)];
    let variant = |(kind, texture), (shadow, glass)| {
        let values = [
            ("LIGHT_KIND", kind),
            ("LIGHT_TEXTURE", texture),
            ("SHADOW_KIND", shadow),
            ("SHADOW_GLASS_LAYERS", glass),
        ];
        values
            .map(|(name, value)| (name.to_owned(), value))
            .to_vec()
    };
    lights
        .into_iter()
        .flat_map(|light| shadows.map(|shadow| variant(light, shadow)))
        .zip([0b1, 0b110, 0b1_1111].into_iter().cycle())
        .map(|(mut variant, phases)| {
            variant.push(("MEDIUM_PHASES".to_owned(), phases));
            variant
        })
        .collect()
}

#[test]
fn every_module_is_valid_by_itself_and_so_is_every_variant() {
    let mut entry_points = 0;
    for (path, _) in modules() {
        let linked = Linker::new().link(path);
        let shader = Reflection::of(linked, ValidationFlags::all());
        let shader = shader.unwrap_or_else(|error| panic!("{error}"));
        let (module, info) = shader.naga();
        entry_points += module.entry_points.len();
        let has = |stage| module.entry_points.iter().any(|entry| entry.stage == stage);
        assert!(
            !has(naga::ShaderStage::Fragment) || has(naga::ShaderStage::Vertex),
            "{path} draws without vertices: it imports no vertex stage"
        );
        let declared = |name: &String| shader.has_override(name);
        let variants: BTreeSet<Vec<(String, u32)>> = light_variants()
            .into_iter()
            .map(|variant| {
                variant
                    .into_iter()
                    .filter(|(name, _)| declared(name))
                    .collect()
            })
            .collect();
        for variant in variants {
            let values: PipelineConstants = variant
                .iter()
                .map(|(name, value)| (name.clone(), f64::from(*value)))
                .collect();
            let (module, _) = process_overrides(module, info, None, &values)
                .unwrap_or_else(|error| panic!("{path}, {variant:?}: {error}"));
            Validator::new(ValidationFlags::all(), Capabilities::all())
                .validate(&module)
                .unwrap_or_else(|error| panic!("{path}, {variant:?}: {error}"));
        }
    }
    assert!(entry_points > 40, "{entry_points}");
}

#[test]
fn modules_import_what_they_use_and_nothing_else() {
    let owners: HashMap<&str, Vec<&str>> =
        modules().iter().fold(HashMap::new(), |mut all, module| {
            for name in module.1.lines().filter_map(declared) {
                all.entry(name).or_insert_with(Vec::new).push(module.0);
            }
            all
        });
    for (name, modules) in &owners {
        assert_eq!(modules.len(), 1, "{name} is declared by {modules:?}");
    }
    for (path, text) in modules() {
        let (imports, own) = split_imports(text, "tyndall").expect("good imports");
        let imported: BTreeSet<&str> = imports.iter().map(|import| &*import.name).collect();
        let used = used_names(&own);
        for name in &imported {
            let is_entry_point = linked_entry_points(path).contains(*name);
            assert!(
                used.contains(name) || is_entry_point,
                "{path} does not use {name}"
            );
        }
        for name in used.difference(&imported) {
            let other = owners.get(name).filter(|modules| !modules.contains(path));
            assert!(
                other.is_none(),
                "{path} uses {name} of {other:?} without importing it"
            );
        }
    }
}

fn linked_entry_points(path: &str) -> BTreeSet<String> {
    let shader = Reflection::new(path).expect("a good module");
    let (module, _) = shader.naga();
    module
        .entry_points
        .iter()
        .map(|entry| entry.name.clone())
        .collect()
}

/// The identifiers of a module that may be another's: no members, no parameters and no variables of its functions.
fn used_names(text: &str) -> BTreeSet<&str> {
    let mut local = BTreeSet::new();
    let mut used = BTreeSet::new();
    for line in text.lines().map(code) {
        for (i, _) in line.match_indices(['.', ':']) {
            let word = if line[i..].starts_with('.') {
                identifiers(&line[i + 1..])
                    .next()
                    .filter(|word| line[i + 1..].starts_with(word))
            } else if line.trim_start().starts_with("case ") {
                None
            } else {
                identifiers(&line[..i])
                    .last()
                    .filter(|word| line[..i].ends_with(word))
            };
            local.extend(word);
        }
        let mut words = identifiers(line).peekable();
        while let Some(word) = words.next() {
            if matches!(word, "let" | "var") {
                local.extend(words.peek());
            }
            used.insert(word);
        }
    }
    used.retain(|word| !local.contains(word));
    used
}

#[test]
fn what_cannot_be_linked_is_named() {
    let a = "import package::b::{x, y};\nfn a() { x(); }\n";
    let b = "fn x() {}\n";
    let linker = Linker::new().module("engine::a", a).module("engine::b", b);
    assert_eq!(
        linker.link("engine::a").unwrap_err().to_string(),
        "engine::a:1: `engine::b` does not declare `y`"
    );
    assert_eq!(
        linker.link("engine::c").unwrap_err().to_string(),
        "the caller: there is no module `engine::c`"
    );
    let clash = "import package::b::x;\nfn x() {}\n";
    let clash = linker.clone().module("engine::c", clash).link("engine::c");
    assert!(matches!(clash, Err(LinkError::Clash { .. })), "{clash:?}");
    let lost = linker
        .clone()
        .module("engine::c", "\nimport package::d::x;\n");
    assert_eq!(
        lost.link("engine::c").unwrap_err().to_string(),
        "engine::c:2: there is no module `engine::d`"
    );
    let open = linker.module("engine::c", "import package::b::{x,\ny\n");
    assert!(matches!(
        open.link("engine::c"),
        Err(LinkError::Syntax { .. })
    ));
}

#[test]
fn modules_come_once_and_lines_are_found_again() {
    let a = "import package::{b::x,\n    c::{y}};\nfn a() { x(); y(); }\n";
    let b = "import package::c::y;\nfn x() { y(); }\n";
    let c = "import package::b::x; // one another\n@group(1) @binding(0) var<uniform> z: vec4f;\nfn y() {}\n";
    let linked = Linker::new()
        .module("tyndall::a", a)
        .module("tyndall::b", b)
        .module("tyndall::c", c)
        .group(1, 3)
        .link("tyndall::a")
        .expect("good modules");
    assert_eq!(linked.wgsl.matches("fn y()").count(), 1);
    assert!(linked.wgsl.contains("@group(3) @binding(0) var<uniform> z"));
    let line = |text: &str| {
        1 + linked
            .wgsl
            .lines()
            .position(|l| l.starts_with(text))
            .unwrap()
    };
    assert_eq!(linked.origin(line("fn a")), Some(("tyndall::a", 3)));
    assert_eq!(linked.origin(line("fn y")), Some(("tyndall::c", 3)));
}

#[test]
fn an_invalid_shader_is_told_with_its_place() {
    let linked = Linker::new()
        .module("engine::a", "\nfn a() -> u32 { return missing(); }\n")
        .link("engine::a");
    let error = Reflection::of(linked, ValidationFlags::all())
        .err()
        .expect("invalid");
    assert!(
        error.starts_with("engine::a:2: ") && error.contains("missing"),
        "{error}"
    );
}

#[test]
fn constants_are_the_shaders() {
    assert_eq!(constant("LIGHT_RECT"), 3);
}
