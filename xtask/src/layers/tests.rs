//! The check on small workspaces that are made on the spot: each rule passes and fails.

use super::check_workspace;
use std::path::Path;

/// The files that make a clean workspace of one crate: `low` below `high`, a folder whose `mod.rs` only hands on.
const CLEAN: &[(&str, &str)] = &[
    (
        "ARCHITECTURE.md",
        "# A\n\n```layers one\nlow\nmiddle, beside\nhigh\n```\n",
    ),
    ("crates/one/Cargo.toml", ""),
    (
        "crates/one/src/lib.rs",
        "mod low; mod middle; mod beside; mod high;\npub use high::High;\n",
    ),
    ("crates/one/src/low.rs", "pub struct Low;\n"),
    ("crates/one/src/beside.rs", "use crate::low::Low;\n"),
    (
        "crates/one/src/middle/mod.rs",
        "mod a;\nmod b;\npub use a::A;\npub use b::B;\n",
    ),
    (
        "crates/one/src/middle/a.rs",
        "use crate::low::Low;\npub struct A(Low);\n",
    ),
    (
        "crates/one/src/middle/b.rs",
        "use super::A;\npub struct B(A);\n",
    ),
    (
        "crates/one/src/high.rs",
        "use crate::middle;\npub struct High(middle::B);\n#[cfg(test)]\nmod tests { use crate::High; }\n",
    ),
];

/// Checks the clean workspace with these files written over it.
fn check(changes: &[(&str, &str)]) -> Result<String, String> {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in CLEAN.iter().chain(changes) {
        write(&folder.path().join(name), text);
    }
    check_workspace(folder.path()).map_err(|error| format!("{error:#}"))
}

fn write(file: &Path, text: &str) {
    std::fs::create_dir_all(file.parent().unwrap()).unwrap();
    std::fs::write(file, text).unwrap();
}

/// Checks that a change fails with words that hold each of these.
fn fails(changes: &[(&str, &str)], words: &[&str]) {
    let message = check(changes).expect_err("it passed");
    for word in words {
        assert!(message.contains(word), "{word:?} is not in:\n{message}");
    }
}

#[test]
fn a_clean_workspace_passes() {
    let summary = check(&[]).unwrap();
    assert!(summary.starts_with("1 crates, 7 files"), "{summary}");
}

#[test]
fn an_import_that_goes_up_fails() {
    for code in [
        "use crate::high::High;\n",
        "use crate::{high::High};\n",
        "use super::high;\n",
        "fn f() -> super::high::High { todo!() }\n",
        "fn f() { let x: Vec<crate::high::High> = vec![]; }\n",
        "fn f() { assert!(crate::high::is_so()); }\n",
        "macro_rules! m { () => { $crate::high::High } }\n",
        "mod inner { use super::super::high::High; }\n",
        "#[cfg(not(test))]\nuse crate::high::High;\n",
    ] {
        let file = ("crates/one/src/low.rs", code);
        fails(
            &[file],
            &["crates/one/src/low.rs:", "`high` is above `low`"],
        );
    }
}

#[test]
fn the_line_is_told() {
    let code = "pub struct Low;\n\nfn f() {\n    crate::high::f();\n}\n";
    fails(
        &[("crates/one/src/low.rs", code)],
        &["crates/one/src/low.rs:4: `crate::high::f`: `high` is above `low`"],
    );
}

#[test]
fn modules_of_one_layer_do_not_know_each_other() {
    fails(
        &[("crates/one/src/beside.rs", "use crate::middle::A;\n")],
        &["`middle` is beside `beside`"],
    );
}

#[test]
fn the_root_is_above_all() {
    fails(
        &[(
            "crates/one/src/middle/a.rs",
            "use crate::High;\npub struct A;\n",
        )],
        &["the crate's root is above `middle`"],
    );
}

#[test]
fn a_name_handed_on_counts_where_it_is_defined_as_well() {
    // `middle` names `low`, which hands on what is above both.
    fails(
        &[
            ("crates/one/src/low.rs", "pub use crate::high::High;\n"),
            (
                "crates/one/src/middle/a.rs",
                "use crate::low::High;\npub struct A;\n",
            ),
        ],
        &[
            "low.rs:1: `crate::high::High`: `high` is above `low`",
            "a.rs:1: `crate::low::High`: `high` is above `middle`",
        ],
    );
}

#[test]
fn tests_may_look_anywhere() {
    for code in [
        "#[cfg(test)]\nuse crate::high::High;\n",
        "#[cfg(all(test, feature = \"gpu\"))]\nmod tests { use crate::high::High; }\n",
        "#[cfg(test)]\nmod nowhere;\n",
        "struct A;\nimpl A { #[cfg(test)] fn f() { crate::high::f() } }\n",
        "#[test]\nfn f() { crate::high::f() }\n",
    ] {
        check(&[("crates/one/src/beside.rs", code)]).unwrap();
    }
}

#[test]
fn files_that_import_each_other_fail_with_the_shortest_circle() {
    fails(
        &[(
            "crates/one/src/middle/a.rs",
            "use super::B;\npub struct A;\n",
        )],
        &[
            "2 files import each other in a circle",
            "middle/a.rs:1: `super::B` is in crates/one/src/middle/b.rs",
            "middle/b.rs:1: `super::A` is in crates/one/src/middle/a.rs",
        ],
    );
}

#[test]
fn a_folder_that_uses_its_children_must_not_be_used_by_them() {
    let mod_file = "crates/one/src/middle/mod.rs";
    let uses = "mod a;\nmod b;\npub use a::A;\npub use b::B;\npub const N: u32 = a::M;\n";
    check(&[(mod_file, uses)]).unwrap();
    let a = (
        "crates/one/src/middle/a.rs",
        "pub const M: u32 = 1;\npub struct A([u32; super::N as usize]);\n",
    );
    fails(
        &[(mod_file, uses), a],
        &["2 files import each other", "`super::N`"],
    );
    // Names that were handed on are used as well as those that were imported.
    let hands_on =
        "mod a;\nmod b;\npub use a::A;\npub use b::B;\npub const N: usize = 1;\nfn f(_: A) {}\n";
    fails(&[(mod_file, hands_on), a], &["2 files import each other"]);
    let only = hands_on.replace("fn f(_: A) {}\n", "");
    check(&[(mod_file, &only), a]).unwrap();
}

#[test]
fn names_come_through_globs() {
    fails(
        &[
            (
                "crates/one/src/middle/mod.rs",
                "mod a;\nmod b;\npub use a::*;\npub use b::*;\n",
            ),
            (
                "crates/one/src/middle/a.rs",
                "use super::B;\npub struct A;\n",
            ),
        ],
        &["`super::B` is in crates/one/src/middle/b.rs"],
    );
}

#[test]
fn the_order_and_the_modules_must_be_the_same() {
    let order = |layers: &str| format!("```layers one\n{layers}```\n");
    for (layers, words) in [
        ("low\nmiddle, beside\n", "module `high` is in no layer"),
        (
            "low\nmiddle, beside\nhigh\nhigher\n",
            "module `higher` has a layer, and does not exist",
        ),
        ("low\nmiddle, beside\nhigh\nlow\n", "`low` is twice"),
        ("low\n\nmiddle, beside\nhigh\n", "an empty name"),
    ] {
        fails(&[("ARCHITECTURE.md", &order(layers))], &[words]);
    }
}

#[test]
fn the_order_and_the_crates_must_be_the_same() {
    let clean = CLEAN[0].1;
    for (document, words) in [
        ("# A\n".to_owned(), "no block of layers"),
        (clean.replace("```\n", ""), "has no end"),
        (clean.replace("layers one", "layers two"), "no such crate"),
        (clean.repeat(2), "two blocks"),
    ] {
        fails(&[("ARCHITECTURE.md", &document)], &[words]);
    }
    fails(
        &[("crates/two/Cargo.toml", "")],
        &["does not say the order of `two`"],
    );
}

#[test]
fn what_cannot_be_read_fails() {
    fails(
        &[("crates/one/src/low.rs", "struct")],
        &["low.rs cannot be parsed"],
    );
    fails(
        &[("crates/one/src/low.rs", "mod gone;\n")],
        &["module `gone` has no file"],
    );
}
