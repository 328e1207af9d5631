//! Which file a path leads to.

use super::collect::{Kind, Mention};
use super::module::{Module, Tree};

/// Longer chains of imports go in circles.
const MAX_HOPS: usize = 32;

/// One file's knowledge of another module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Import {
    /// The file that has it.
    pub(super) from: String,
    /// The line, from 1.
    pub(super) line: usize,
    /// The path as it is written.
    pub(super) path: String,
    pub(super) kind: Kind,
    /// The top-level module that has it; `None` for the root.
    pub(super) from_top: Option<String>,
    /// The top-level module that is named; `None` for the root.
    pub(super) named_top: Option<String>,
    /// The top-level module that defines what is named, once all that hand it on are passed.
    pub(super) top: Option<String>,
    /// The file that defines what is named.
    pub(super) file: String,
}

/// All imports of a crate, within itself.
pub(super) fn imports(tree: &Tree) -> Vec<Import> {
    let of_module = |module: &Module| -> Vec<Import> {
        let mentions = module.content.mentions.iter();
        mentions
            .filter_map(|mention| import(tree, module, mention))
            .collect()
    };
    tree.modules().iter().flat_map(of_module).collect()
}

fn import(tree: &Tree, module: &Module, mention: &Mention) -> Option<Import> {
    let named = absolute(tree, module, &mention.path, MAX_HOPS)?;
    let names_itself = mention.kind == Kind::Code && mention.path.len() == 1;
    if names_itself && !module.content.aliases.contains_key(&mention.path[0]) {
        return None;
    }
    let target = definition(tree, named.clone(), MAX_HOPS);
    let top = |module: &Module| module.path.first().cloned();
    Some(Import {
        from: tree.file_name(module.file).to_owned(),
        line: mention.line,
        path: mention.path.join("::"),
        kind: mention.kind,
        from_top: top(module),
        named_top: top(innermost(tree, &named)?),
        top: top(innermost(tree, &target)?),
        file: tree.file_name(innermost(tree, &target)?.file).to_owned(),
    })
}

/// The path from the crate's root; `None` where it leads into another crate or to a local name.
fn absolute(tree: &Tree, module: &Module, path: &[String], hops: usize) -> Option<Vec<String>> {
    let (first, rest) = path.split_first()?;
    let hops = hops.checked_sub(1)?;
    let mut base = match first.as_str() {
        "crate" => Vec::new(),
        "self" => module.path.clone(),
        "super" => parent(&module.path)?,
        _ => match module.content.aliases.get(first) {
            // `use glam;` and `use shadow::shadow;`: the name that is imported is not the one that is meant here.
            Some(target) if target.first() != Some(first) => absolute(tree, module, target, hops)?,
            Some(target) => {
                let base = child(tree, &module.path, first)?;
                [&base[..], &target[1..]].concat()
            }
            None => child(tree, &module.path, first)
                .or_else(|| through_globs(tree, module, first, hops))?,
        },
    };
    let mut rest = rest;
    while let Some(("super", more)) = rest.split_first().map(|(f, r)| (f.as_str(), r)) {
        base = parent(&base)?;
        rest = more;
    }
    base.extend_from_slice(rest);
    Some(base)
}

fn parent(path: &[String]) -> Option<Vec<String>> {
    path.split_last().map(|(_, parent)| parent.to_vec())
}

/// The module of this name below another.
fn child(tree: &Tree, path: &[String], name: &String) -> Option<Vec<String>> {
    let below = [path, std::slice::from_ref(name)].concat();
    tree.find(&below).map(|module| module.path.clone())
}

/// A name that a `use path::*` of the module brings in.
fn through_globs(tree: &Tree, module: &Module, name: &String, hops: usize) -> Option<Vec<String>> {
    module.content.globs.iter().find_map(|glob| {
        // A glob's own path must not be looked for among the globs.
        let source = match glob.first().map(String::as_str) {
            Some("crate" | "self" | "super") => absolute(tree, module, glob, hops)?,
            Some(_) => [&child(tree, &module.path, &glob[0])?[..], &glob[1..]].concat(),
            None => Vec::new(),
        };
        let source = tree.find(&source)?;
        let content = &source.content;
        if content.items.contains(name) {
            return Some([source.path.as_slice(), std::slice::from_ref(name)].concat());
        }
        match content.aliases.contains_key(name) {
            true => absolute(tree, source, std::slice::from_ref(name), hops),
            false => through_globs(tree, source, name, hops.checked_sub(1)?),
        }
    })
}

/// Follows names that modules hand on to where they are defined.
fn definition(tree: &Tree, path: Vec<String>, hops: usize) -> Vec<String> {
    let Some(module) = innermost(tree, &path) else {
        return path;
    };
    let Some((name, rest)) = path[module.path.len()..].split_first() else {
        return path;
    };
    if hops == 0 || module.content.items.contains(name) {
        return path;
    }
    let name = std::slice::from_ref(name);
    match absolute(tree, module, name, hops) {
        Some(target) => definition(tree, [&target[..], rest].concat(), hops - 1),
        None => path,
    }
}

/// The innermost module that a path goes through.
fn innermost<'a>(tree: &'a Tree, path: &[String]) -> Option<&'a Module> {
    (0..=path.len()).rev().find_map(|n| tree.find(&path[..n]))
}
