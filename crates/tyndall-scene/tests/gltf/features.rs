//! Features of glTF that are read, one hand-made file each.

use crate::document::{Document, F32, Folder, U8, U16, U32, floats};
use glam::{Affine3A, DAffine3, DVec3, Quat, Vec2, Vec3, vec2, vec3};
use serde_json::{Value, json};
use tyndall::frame::{Emitter, Projection};
use tyndall_scene::scene::{Blocking, Primitive, Scene, Wrap};

fn only_primitive(scene: &Scene) -> &Primitive {
    let [mesh] = &scene.meshes[..] else {
        panic!("{} meshes", scene.meshes.len())
    };
    let [primitive] = &mesh.primitives[..] else {
        panic!("{} primitives", mesh.primitives.len())
    };
    primitive
}

/// The vertices that the corners of a primitive of [`Document::with_primitive`] came from.
fn corners(primitive: &Primitive) -> Vec<usize> {
    primitive
        .indices
        .iter()
        .map(|&index| primitive.positions[index as usize].x as usize)
        .collect()
}

#[test]
fn topologies() {
    const POINTS: u32 = 0;
    const LINE_STRIP: u32 = 3;
    const TRIANGLES: u32 = 4;
    const STRIP: u32 = 5;
    const FAN: u32 = 6;
    let cases: &[(u32, &[u8], &[usize])] = &[
        (TRIANGLES, &[0, 1, 2, 4, 3, 2], &[0, 1, 2, 4, 3, 2]),
        (TRIANGLES, &[0, 1, 2, 3, 4], &[0, 1, 2]),
        (STRIP, &[0, 1, 2, 3, 4], &[0, 1, 2, 1, 3, 2, 2, 3, 4]),
        (FAN, &[0, 1, 2, 3], &[1, 2, 0, 2, 3, 0]),
        (STRIP, &[0, 1], &[]),
        (FAN, &[0], &[]),
        (POINTS, &[0, 1, 2], &[]),
        (LINE_STRIP, &[0, 1, 2], &[]),
    ];
    for (mode, indices, expected) in cases {
        let mut document = Document::with_primitive(5, Value::Null);
        let accessor = document.accessor(U8, "SCALAR", indices, 1);
        document.primitive()["indices"] = accessor.into();
        document.primitive()["mode"] = (*mode).into();
        let scene = document.load().unwrap();
        let found = scene.meshes[0].primitives.first().map(corners);
        assert_eq!(found.unwrap_or_default(), *expected, "mode {mode}");
    }
}

#[test]
fn index_types() {
    let order = [2u8, 0, 1, 1, 3, 2];
    let wide: Vec<u8> = order.iter().flat_map(|&i| [i, 0]).collect();
    let widest: Vec<u8> = order.iter().flat_map(|&i| [i, 0, 0, 0]).collect();
    type Indices<'a> = Option<(u32, &'a [u8], usize)>;
    let cases: [(&str, Indices<'_>, &[usize]); 4] = [
        ("none", None, &[0, 1, 2, 3, 4, 5]),
        ("u8", Some((U8, &order, 1)), &[2, 0, 1, 1, 3, 2]),
        ("u16", Some((U16, &wide, 2)), &[2, 0, 1, 1, 3, 2]),
        ("u32", Some((U32, &widest, 4)), &[2, 0, 1, 1, 3, 2]),
    ];
    for (name, indices, expected) in cases {
        let mut document = Document::with_primitive(6, Value::Null);
        if let Some((component, bytes, size)) = indices {
            let accessor = document.accessor(component, "SCALAR", bytes, size);
            document.primitive()["indices"] = accessor.into();
        }
        let scene = document.load().unwrap();
        assert_eq!(corners(only_primitive(&scene)), expected, "{name}");
    }
}

#[test]
fn interleaved_data_keeps_its_stride_and_offset() {
    let mut document = Document::new(json!([{"mesh": 0}]), Value::Null);
    let vertices: Vec<f32> = (0..3u8)
        .flat_map(|i| [9.0, i.into(), (i * i).into(), 0.5, 9.0])
        .collect();
    let view = document.view(&floats(&vertices));
    document.json["bufferViews"][view]["byteStride"] = 20.into();
    document.json["accessors"] = json!([{
        "bufferView": view, "byteOffset": 4, "componentType": F32, "type": "VEC3", "count": 3
    }]);
    document.json["meshes"] = json!([{"primitives": [{"attributes": {"POSITION": 0}}]}]);
    let scene = document.load().unwrap();
    let expected = [
        vec3(0.0, 0.0, 0.5),
        vec3(1.0, 1.0, 0.5),
        vec3(2.0, 4.0, 0.5),
    ];
    assert_eq!(only_primitive(&scene).positions, expected);
}

#[test]
fn sparse_accessors_replace_elements_of_their_base_or_of_zeros() {
    for has_base in [true, false] {
        let mut document = Document::with_primitive(3, Value::Null);
        let indices = document.view(&[2]);
        let values = document.view(&floats(&[7.0, 8.0, 9.0]));
        let accessor = &mut document.json["accessors"][0];
        accessor["sparse"] = json!({
            "count": 1,
            "indices": {"bufferView": indices, "componentType": U8},
            "values": {"bufferView": values},
        });
        if !has_base {
            accessor.as_object_mut().unwrap().remove("bufferView");
        }
        let scene = document.load().unwrap();
        let second = if has_base {
            vec3(1.0, 1.0, 0.0)
        } else {
            Vec3::ZERO
        };
        let expected = [Vec3::ZERO, second, vec3(7.0, 8.0, 9.0)];
        assert_eq!(only_primitive(&scene).positions, expected);
    }
}

#[test]
fn normals_are_normalised_or_made() {
    let shared: &[u8] = &[0, 1, 2, 2, 1, 0];
    type Normals = Option<[f32; 9]>;
    let cases: [(&str, Normals, &[Vec3]); 3] = [
        (
            "given",
            Some([0.0, 0.0, 2.0, 0.0, 3.0, 0.0, 0.5, 0.0, 0.0]),
            &[Vec3::Z, Vec3::Y, Vec3::X],
        ),
        (
            "without direction",
            Some([0.0, 0.0, 0.0, 0.0, 3.0, 0.0, 0.5, 0.0, 0.0]),
            &[
                Vec3::Z,
                Vec3::Z,
                Vec3::Z,
                Vec3::NEG_Z,
                Vec3::NEG_Z,
                Vec3::NEG_Z,
            ],
        ),
        (
            "missing",
            None,
            &[
                Vec3::Z,
                Vec3::Z,
                Vec3::Z,
                Vec3::NEG_Z,
                Vec3::NEG_Z,
                Vec3::NEG_Z,
            ],
        ),
    ];
    for (name, normals, expected) in cases {
        let mut document = Document::with_primitive(3, Value::Null);
        let accessor = document.accessor(U8, "SCALAR", shared, 1);
        document.primitive()["indices"] = accessor.into();
        if let Some(normals) = normals {
            let accessor = document.accessor(F32, "VEC3", &floats(&normals), 12);
            document.primitive()["attributes"]["NORMAL"] = accessor.into();
        }
        let scene = document.load().unwrap();
        let primitive = only_primitive(&scene);
        assert_eq!(primitive.normals, expected, "{name}");
        assert_eq!(corners(primitive), [0, 1, 2, 2, 1, 0], "{name}");
    }
}

/// A 2 x 1 PNG: red, half-transparent green.
fn png() -> Vec<u8> {
    let image = image::RgbaImage::from_raw(2, 1, vec![255, 0, 0, 255, 0, 255, 0, 128]).unwrap();
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

fn textured(info: Value) -> Value {
    json!({
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": info}}],
        "textures": [{"source": 0, "sampler": 0}],
        "samplers": [{"wrapS": 33071, "wrapT": 33648}],
        "images": [{"uri": "picture%20one.png"}],
    })
}

#[test]
fn uvs_of_the_texture_in_use_with_its_transform() {
    let half_turn = std::f32::consts::FRAC_PI_2;
    let transform =
        json!({"offset": [0.5, 0.25], "rotation": half_turn, "scale": [2.0, 4.0], "texCoord": 1});
    // Set 0 is (0, 0), (1/4, 1/4), (1/2, 1/2) as floats; set 1 is (0, 0), (1, 0), (0, 1) as normalised bytes.
    let cases: [(&str, Value, [Vec2; 3]); 3] = [
        (
            "set 0",
            json!({"index": 0}),
            [Vec2::ZERO, Vec2::splat(0.25), Vec2::splat(0.5)],
        ),
        (
            "set 1",
            json!({"index": 0, "texCoord": 1}),
            [Vec2::ZERO, Vec2::X, Vec2::Y],
        ),
        (
            "transformed: a quarter turn takes +u to -v, where v points down",
            json!({"index": 0, "extensions": {"KHR_texture_transform": transform}}),
            [
                vec2(0.5, 0.25),
                vec2(0.5, 0.25 - 2.0),
                vec2(0.5 + 4.0, 0.25),
            ],
        ),
    ];
    for (name, info, expected) in cases {
        let mut document = Document::with_primitive(3, textured(info));
        let first = floats(&[0.0, 0.0, 0.25, 0.25, 0.5, 0.5]);
        let first = document.accessor(F32, "VEC2", &first, 8);
        let second = document.accessor(U8, "VEC2", &[0, 0, 255, 0, 0, 255], 2);
        document.json["accessors"][second]["normalized"] = true.into();
        let primitive = document.primitive();
        primitive["material"] = 0.into();
        primitive["attributes"]["TEXCOORD_0"] = first.into();
        primitive["attributes"]["TEXCOORD_1"] = second.into();
        let folder = Folder::new();
        folder.write("picture one.png", &png());
        let scene = folder.load("scene.glb", &document.to_glb()).unwrap();
        for (found, expected) in only_primitive(&scene).uvs.iter().zip(expected) {
            // Measured: 2e-7, the cosine of a rounded pi/2.
            assert!(
                found.abs_diff_eq(expected, 1e-6),
                "{name}: {found}, {expected}"
            );
        }
    }
}

#[test]
fn images_from_files_views_and_data_uris() {
    let png = png();
    let percent_encoded: String = png.iter().map(|byte| format!("%{byte:02x}")).collect();
    let sources = [
        json!({"uri": "picture%20one.png"}),
        json!({"uri": format!("data:image/png,{percent_encoded}")}),
        json!({"bufferView": 1}),
    ];
    for image in sources {
        let mut document = Document::with_primitive(3, textured(json!({"index": 0})));
        document.view(&png);
        document.primitive()["material"] = 0.into();
        document.json["images"] = json!([image]);
        let folder = Folder::new();
        folder.write("picture one.png", &png);
        let scene = folder.load("scene.glb", &document.to_glb()).unwrap();
        let [texture] = &scene.textures[..] else {
            panic!("{} textures", scene.textures.len())
        };
        assert_eq!(texture.size, [2, 1]);
        assert_eq!(texture.texels, [[255, 0, 0, 255], [0, 255, 0, 128]]);
        assert_eq!(texture.wrap, [Wrap::ClampToEdge, Wrap::MirroredRepeat]);
        assert_eq!(scene.materials[0].base_color_texture, Some(0));
    }
}

#[test]
fn images_that_nothing_uses_may_be_missing() {
    let document = Document::with_primitive(3, textured(json!({"index": 0})));
    assert!(document.load().unwrap().textures.is_empty());
}

#[test]
fn buffers_from_files_and_data_uris() {
    let binary = floats(&[0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 2.0, 4.0, 0.0]);
    let encoded = "AAAAAAAAAAAAAAAAAACAPwAAgD8AAAAAAAAAQAAAgEAAAAAA";
    let percent_encoded: String = binary.iter().map(|byte| format!("%{byte:02X}")).collect();
    for uri in [
        "the%20data.bin".to_owned(),
        format!("data:application/octet-stream;base64,{encoded}"),
        format!("data:application/octet-stream,{percent_encoded}"),
    ] {
        let mut document = Document::with_primitive(3, Value::Null);
        document.json["buffers"] = json!([{"byteLength": binary.len(), "uri": uri}]);
        let folder = Folder::new();
        folder.write("the data.bin", &binary);
        let text = document.json.to_string();
        let scene = folder.load("scene.gltf", text.as_bytes()).unwrap();
        assert_eq!(corners(only_primitive(&scene)), [0, 1, 2], "{uri}");
    }
}

#[test]
fn hierarchies_put_parents_first() {
    let nodes = json!([
        {"name": "leaf", "translation": [1, 2, 3]},
        {"name": "root", "children": [2], "scale": [2, 2, 2]},
        {"name": "branch", "children": [0], "matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 4, 5, 6, 1]},
    ]);
    let mut document = Document::new(nodes, Value::Null);
    document.json["scenes"] = json!([{"nodes": [1]}]);
    let scene = document.load().unwrap();
    let names: Vec<&str> = scene.nodes.iter().map(|node| node.name.as_str()).collect();
    assert_eq!(names, ["root", "branch", "leaf"]);
    let parents: Vec<_> = scene.nodes.iter().map(|node| node.parent).collect();
    assert_eq!(parents, [None, Some(0), Some(1)]);
    let world_from_leaf = scene.nodes.iter().fold(DAffine3::IDENTITY, |world, node| {
        world * node.parent_from_local
    });
    // The branch turns x to y: 2 * ((-2, 1, 3) + (4, 5, 6)).
    assert_eq!(
        world_from_leaf.transform_point3(DVec3::ZERO),
        DVec3::new(4.0, 12.0, 18.0)
    );
}

#[test]
fn scene_choice() {
    let nodes = json!([{"name": "a"}, {"name": "b"}, {"name": "c", "children": [0]}]);
    let scenes = json!([{"nodes": [0]}, {"nodes": [1]}]);
    let cases: [(&str, Value, &[&str]); 3] = [
        ("default", json!({"scene": 1, "scenes": scenes}), &["b"]),
        ("first", json!({"scene": null, "scenes": scenes}), &["a"]),
        (
            "roots where there are no scenes",
            json!({"scene": null, "scenes": []}),
            &["c", "a", "b"],
        ),
    ];
    for (name, rest, expected) in cases {
        let scene = Document::new(nodes.clone(), rest).load().unwrap();
        let found: Vec<&str> = scene.nodes.iter().map(|node| node.name.as_str()).collect();
        assert_eq!(found, expected, "{name}");
    }
}

#[test]
fn transforms_from_parts() {
    let turn = Quat::from_rotation_y(0.5);
    let node = json!({
        "translation": [1, 2, 3], "scale": [1, 2, 3],
        // Twice as long as it should be: it is normalised.
        "rotation": (turn * 2.0).to_array(),
    });
    let scene = Document::new(json!([node]), Value::Null).load().unwrap();
    let expected =
        Affine3A::from_scale_rotation_translation(vec3(1.0, 2.0, 3.0), turn, vec3(1.0, 2.0, 3.0));
    // Measured: 6e-8, rounding.
    assert!(
        scene.nodes[0]
            .parent_from_local
            .abs_diff_eq(expected.as_daffine3(), 1e-6)
    );
}

#[test]
fn materials() {
    let cases = [
        (json!({}), Blocking::Opaque, [1.0, 1.0, 1.0, 1.0], [0.0; 3]),
        (
            json!({"alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0.125, 0.75]}}),
            Blocking::Masked { cutoff: 0.5 },
            [0.5, 0.25, 0.125, 0.75],
            [0.0; 3],
        ),
        (
            json!({"alphaMode": "MASK", "alphaCutoff": 0.25, "emissiveFactor": [1.0, 0.5, 0.0]}),
            Blocking::Masked { cutoff: 0.25 },
            [1.0; 4],
            [1.0, 0.5, 0.0],
        ),
        (
            json!({"alphaMode": "BLEND", "extensions": {"KHR_materials_unlit": {}}}),
            Blocking::Blended,
            [1.0; 4],
            [0.0; 3],
        ),
        (
            json!({"alphaMode": "BLEND", "emissiveFactor": [1.0, 0.5, 0.25], "extensions": {
                "KHR_materials_transmission": {"transmissionFactor": 0.75},
                "KHR_materials_emissive_strength": {"emissiveStrength": 8.0},
            }}),
            Blocking::Transmissive { transmission: 0.75 },
            [1.0; 4],
            [8.0, 4.0, 2.0],
        ),
        (
            json!({"extensions": {"KHR_materials_transmission": {}}}),
            Blocking::Opaque,
            [1.0; 4],
            [0.0; 3],
        ),
    ];
    for (json, blocking, base_color, emissive) in cases {
        let mut document = Document::with_primitive(3, json!({"materials": [json]}));
        document.primitive()["material"] = 0.into();
        let scene = document.load().unwrap();
        let [material] = &scene.materials[..] else {
            panic!("{} materials", scene.materials.len())
        };
        assert_eq!(material.blocking, blocking, "{json}");
        assert_eq!(material.base_color, base_color, "{json}");
        assert_eq!(material.emissive, emissive, "{json}");
    }
}

#[test]
fn lights() {
    let cases = [
        (
            json!({"type": "directional", "color": [1.0, 0.5, 0.25], "intensity": 8.0}),
            Emitter::Directional {
                direction: [0.0, 0.0, -1.0],
                illuminance: [8.0, 4.0, 2.0],
            },
        ),
        (
            json!({"type": "point", "range": 3.0}),
            Emitter::Point {
                position: [0.0; 3],
                intensity: [1.0; 3],
                radius: 0.0,
            },
        ),
        (
            json!({"type": "spot", "intensity": 2.0, "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}}),
            Emitter::Spot {
                position: [0.0; 3],
                direction: [0.0, 0.0, -1.0],
                intensity: [2.0; 3],
                inner: 0.25,
                outer: 0.5,
                radius: 0.0,
            },
        ),
    ];
    for (light, expected) in cases {
        let extension = json!({"KHR_lights_punctual": {"lights": [light]}});
        let node = json!({"extensions": {"KHR_lights_punctual": {"light": 0}}});
        let scene = Document::new(json!([node]), json!({"extensions": extension}))
            .load()
            .unwrap();
        assert_eq!(scene.nodes[0].light, Some(expected), "{light}");
    }
}

#[test]
fn cones_as_sharp_and_as_wide_as_gltf_allows() {
    let half = std::f32::consts::FRAC_PI_2;
    for (inner, outer) in [(0.5f32, 0.5f32), (0.0, half), (half, half)] {
        let spot = json!({"innerConeAngle": inner, "outerConeAngle": outer});
        let extension =
            json!({"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": spot}]}});
        let node = json!({"extensions": {"KHR_lights_punctual": {"light": 0}}});
        let scene = Document::new(json!([node]), json!({"extensions": extension}))
            .load()
            .unwrap();
        let stated = [inner, outer];
        let Some(Emitter::Spot { inner, outer, .. }) = scene.nodes[0].light else {
            panic!("{:?}", scene.nodes[0].light)
        };
        assert_eq!([inner, outer], stated);
    }
}

#[test]
fn cameras() {
    let tangent = 0.5f32.tan();
    let cases = [
        (
            json!({"type": "perspective", "perspective": {"yfov": 1.0, "aspectRatio": 2.0, "znear": 0.5, "zfar": 100.0}}),
            Projection::Perspective {
                half_extent: [2.0 * tangent, tangent],
                center: [0.0; 2],
                near: 0.5,
                far: 100.0,
            },
        ),
        (
            // No far plane: 1000 times the near one, for there is nothing behind that.
            json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.5}}),
            Projection::Perspective {
                half_extent: [tangent * 4.0 / 3.0, tangent],
                center: [0.0; 2],
                near: 0.5,
                far: 500.0,
            },
        ),
        (
            json!({"type": "orthographic", "orthographic": {"xmag": 3.0, "ymag": 2.0, "znear": 0.0, "zfar": 10.0}}),
            Projection::Orthographic {
                half_extent: [3.0, 2.0],
                center: [0.0; 2],
                near: 0.0,
                far: 10.0,
            },
        ),
    ];
    for (camera, expected) in cases {
        let document = Document::new(json!([{"camera": 0}]), json!({"cameras": [camera]}));
        let scene = document.load().unwrap();
        assert_eq!(scene.nodes[0].camera, Some(expected), "{camera}");
    }
}

#[test]
fn cameras_without_a_far_plane_see_everything() {
    let camera = json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.01}});
    let mut document = Document::with_primitive(6, json!({"cameras": [camera]}));
    document.json["nodes"] = json!([{"mesh": 0}, {"camera": 0, "translation": [4, 0, 3]}]);
    document.json["scenes"] = json!([{"nodes": [0, 1]}]);
    let scene = document.load().unwrap();
    let camera = scene.nodes.iter().find_map(|node| node.camera);
    let Some(Projection::Perspective { far, .. }) = camera else {
        panic!("{camera:?}")
    };
    // The farthest vertex is (5, 25, 0): sqrt(1 + 25^2 + 3^2).
    assert!((far - 635f32.sqrt()).abs() < 1e-5, "{far}");
}

#[test]
fn quantised_attributes_where_the_extension_says_so() {
    let mut document = Document::new(json!([{"mesh": 0}]), Value::Null);
    // Padded to 4 bytes, as glTF wants vertex attributes.
    let bytes = [0, 0, 0, 0, 255, 0, 0, 0, 0, 51, 0, 0];
    let view = document.view(&bytes);
    document.json["bufferViews"][view]["byteStride"] = 4.into();
    document.json["accessors"] = json!([{
        "bufferView": view, "componentType": U8, "normalized": true, "type": "VEC3", "count": 3
    }]);
    document.json["meshes"] = json!([{"primitives": [{"attributes": {"POSITION": 0}}]}]);
    let refusal = document.refusal();
    assert!(refusal.contains("found Vec3 of U8"), "{refusal}");
    document.json["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
    document.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let scene = document.load().unwrap();
    let expected = [Vec3::ZERO, Vec3::X, vec3(0.0, 0.2, 0.0)];
    assert_eq!(only_primitive(&scene).positions, expected);
}

#[test]
fn meshes_and_materials_are_shared() {
    let mut document = Document::with_primitive(3, json!({"materials": [{}]}));
    document.json["nodes"] = json!([{"mesh": 0}, {"mesh": 0}]);
    document.json["scenes"] = json!([{"nodes": [0, 1]}]);
    let primitive = document.primitive().clone();
    document.json["meshes"][0]["primitives"] = json!([primitive, primitive]);
    let scene = document.load().unwrap();
    let meshes: Vec<_> = scene.nodes.iter().map(|node| node.mesh).collect();
    assert_eq!(meshes, [Some(0), Some(0)]);
    assert_eq!((scene.meshes.len(), scene.materials.len()), (1, 1));
}

#[test]
fn animations_move_nodes_and_rest_where_they_have_no_channel() {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    for (name, interpolation, translations, at_half) in [
        (
            "LINEAR",
            "LINEAR",
            &[[0.0f32; 3], [2.0, 4.0, 6.0]][..],
            [1.0, 2.0, 3.0],
        ),
        ("STEP", "STEP", &[[0.0; 3], [2.0, 4.0, 6.0]], [0.0; 3]),
        (
            "CUBICSPLINE",
            "CUBICSPLINE",
            &[
                [0.0; 3],
                [0.0; 3],
                [0.0; 3],
                [0.0; 3],
                [2.0, 4.0, 6.0],
                [0.0; 3],
            ],
            [1.0, 2.0, 3.0],
        ),
    ] {
        let nodes = json!([{"name": "still"}, {"name": "moved", "scale": [3, 3, 3], "translation": [9, 9, 9]}]);
        let mut document = Document::new(nodes, Value::Null);
        let times = document.accessor(F32, "SCALAR", &floats(&[0.0, 1.0]), 4);
        let places = document.accessor(F32, "VEC3", &floats(translations.as_flattened()), 12);
        // A quarter turn about y, as normalised 16-bit integers.
        let unit = |x: f32| ((x * 32767.0) as i16).to_le_bytes();
        let turns: Vec<u8> = [0.0, 0.0, 0.0, 1.0, 0.0, half, 0.0, half]
            .into_iter()
            .flat_map(unit)
            .collect();
        let turns = document.accessor(5122, "VEC4", &turns, 8);
        document.json["accessors"][turns]["normalized"] = true.into();
        document.json["animations"] = json!([{
            "samplers": [
                {"input": times, "output": places, "interpolation": interpolation},
                {"input": times, "output": turns},
            ],
            "channels": [
                {"sampler": 0, "target": {"node": 1, "path": "translation"}},
                {"sampler": 1, "target": {"node": 1, "path": "rotation"}},
            ],
        }]);
        let mut scene = document.load().unwrap();
        let still = scene.nodes.iter().position(|n| n.name == "still").unwrap();
        let moved = scene.nodes.iter().position(|n| n.name == "moved").unwrap();
        assert_eq!(
            scene.nodes[moved].parent_from_local.translation,
            DVec3::splat(9.0)
        );
        scene.pose(0.5);
        let place = scene.nodes[moved].parent_from_local;
        let expected = Affine3A::from_scale_rotation_translation(
            Vec3::splat(3.0),
            Quat::from_rotation_y(std::f32::consts::FRAC_PI_4),
            at_half.into(),
        );
        assert!(
            place.abs_diff_eq(expected.as_daffine3(), 1e-3),
            "{name}: {place}"
        );
        assert_eq!(scene.nodes[still].parent_from_local, DAffine3::IDENTITY);
    }
}

#[test]
fn broken_animations_are_refused_with_what_was_found() {
    for (times, path, node, message) in [
        (
            &[1.0, 0.0][..],
            "translation",
            0,
            "animation 0, channel 0, input: times must not fall, found 0 after 1",
        ),
        (
            &[0.0],
            "translation",
            0,
            "animation 0, channel 0, output: must have 1 elements for 1 keys, found 2",
        ),
        (
            &[0.0, 1.0],
            "translation",
            7,
            "animation 0, channel 0, target: node 7 is out of range for 1 nodes",
        ),
        (
            &[0.0, 1.0],
            "colour",
            0,
            "animation 0, channel 0, target: path must be translation, rotation, scale or weights, found another word",
        ),
        (
            &[0.0, 1.0],
            "rotation",
            0,
            "animation 0, channel 0, accessor 1: must be Vec4 of F32 or normalized I8, U8, I16 or U16, found Vec3 of F32",
        ),
    ] {
        let mut document = Document::new(json!([{}]), Value::Null);
        let input = document.accessor(F32, "SCALAR", &floats(times), 4);
        let output = document.accessor(F32, "VEC3", &floats(&[0.0; 6]), 12);
        document.json["animations"] = json!([{
            "samplers": [{"input": input, "output": output}],
            "channels": [{"sampler": 0, "target": {"node": node, "path": path}}],
        }]);
        assert_eq!(document.refusal(), message);
    }
}
