//! Files made by others, where they are present.

use std::{
    fs,
    panic::catch_unwind,
    path::{Path, PathBuf},
};

use serde_json::Value;
use tyndall_scene::{load::load, scene::Scene};

/// Files that Khronos' validator finds no error in and that are refused all the same, with the messages about them.
const REFUSED: &[(&str, &str)] = &[
    // The reports are of a validator that lets unknown things pass.
    (
        "accessor/unknown_type.gltf",
        "`accessors[0].type`: invalid value",
    ),
    ("light/unknown_type.gltf", "lights[0].type`: invalid value"),
    ("asset/min_version_valid.gltf", "must be 2.0, found 2.1"),
    // The `gltf` crate wants these fields.
    ("scene/custom_property.gltf", "missing field `nodes`"),
    ("root/unused_objects.gltf", "missing field `node`"),
    (
        "target/missing_extension_declaration.gltf",
        "missing field `node`",
    ),
    (
        "channel/target/custom_property.gltf",
        "missing field `node`",
    ),
    ("channel/target/valid.gltf", "missing field `node`"),
];

/// The folder of shared test scenes beside the workspace, if it is there.
fn shared_assets(test: &str) -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/assets");
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("skipped: {test}: there is no {}", folder.display());
    None
}

fn files_below(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(files_below(&path));
        } else {
            files.push(path);
        }
    }
    files
}

/// Number of errors that the validator's report beside a file lists.
fn reported_errors(file: &Path) -> u64 {
    let mut report = file.as_os_str().to_owned();
    report.push(".report.json");
    let report: Value = serde_json::from_slice(&fs::read(report).unwrap()).unwrap();
    report["issues"]["numErrors"].as_u64().unwrap()
}

#[test]
fn the_validators_files_load_or_are_refused() {
    let Some(assets) = shared_assets("the validator's files") else {
        return;
    };
    let files: Vec<PathBuf> = files_below(&assets.join("gltf-validator"))
        .into_iter()
        .filter(|path| path.extension().is_some_and(|e| e == "gltf" || e == "glb"))
        .collect();
    assert_eq!(files.len(), 188);
    for file in files {
        let shown = file.display();
        let result = catch_unwind(|| load(&file)).unwrap_or_else(|_| panic!("{shown} panics"));
        let expected = REFUSED.iter().find(|(name, _)| file.ends_with(name));
        match (result, expected) {
            (Ok(_), Some(_)) => panic!("{shown} loads"),
            (Err(error), Some((_, message))) => {
                assert!(error.to_string().contains(message), "{error}");
            }
            (Err(error), None) => assert_ne!(reported_errors(&file), 0, "{error}"),
            (Ok(_), None) => {}
        }
    }
}

fn triangles(scene: &Scene) -> usize {
    scene
        .nodes
        .iter()
        .filter_map(|node| node.mesh)
        .flat_map(|mesh| &scene.meshes[mesh].primitives)
        .map(|primitive| primitive.indices.len() / 3)
        .sum()
}

#[test]
fn whole_scenes() {
    let Some(assets) = shared_assets("whole scenes") else {
        return;
    };
    // Triangles, nodes with a camera, nodes with a light.
    let cases = [
        ("angel.glb", 15_002, 1, 1),
        ("box-wall.glb", 24, 0, 0),
        ("buddha.glb", 51_416, 1, 1),
        ("bunny.glb", 69_453, 1, 1),
        ("city.glb", 41_183, 0, 0),
        ("donuts-dragon.glb", 599_258, 0, 0),
        ("dragon.glb", 202_522, 1, 1),
        ("hall.glb", 360, 0, 1),
        ("sibenik.glb", 75_145, 0, 0),
        ("terrain.glb", 275_772, 0, 0),
    ];
    for (name, expected, cameras, lights) in cases {
        let scene = load(&assets.join(name)).unwrap();
        assert_eq!(triangles(&scene), expected, "{name}");
        let count = |has: fn(&tyndall_scene::scene::Node) -> bool| {
            scene.nodes.iter().filter(|node| has(node)).count()
        };
        assert_eq!(count(|node| node.camera.is_some()), cameras, "{name}");
        assert_eq!(count(|node| node.light.is_some()), lights, "{name}");
    }
}
