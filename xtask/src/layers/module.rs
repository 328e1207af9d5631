//! The modules of a crate, found by following `mod` from its root file.

use super::collect::{self, Content};
use anyhow::{Context, ensure};
use std::path::{Path, PathBuf};

/// A module, in a file of its own or within another's.
pub(super) struct Module {
    /// Names from the crate's root down; empty for the root itself.
    pub(super) path: Vec<String>,
    /// The file, as an index into the tree's.
    pub(super) file: usize,
    pub(super) content: Content,
}

/// All modules of a crate but those of tests.
pub(super) struct Tree {
    /// Names of the files, from the workspace's root.
    files: Vec<String>,
    modules: Vec<Module>,
}

impl Tree {
    /// Reads a crate, whose root file this is. Files are named from `workspace` on.
    pub(super) fn load(workspace: &Path, root: &Path) -> anyhow::Result<Self> {
        let mut tree = Self {
            files: Vec::new(),
            modules: Vec::new(),
        };
        let folder = root.parent().unwrap_or(root);
        tree.read_file(workspace, root, Vec::new(), folder)?;
        Ok(tree)
    }

    pub(super) fn modules(&self) -> &[Module] {
        &self.modules
    }

    pub(super) fn file_name(&self, file: usize) -> &str {
        &self.files[file]
    }

    pub(super) fn file_count(&self) -> usize {
        self.files.len()
    }

    /// The module of exactly this path.
    pub(super) fn find(&self, path: &[String]) -> Option<&Module> {
        self.modules.iter().find(|module| module.path == path)
    }

    /// Names of the modules right below the root.
    pub(super) fn top_level(&self) -> impl Iterator<Item = &str> {
        let paths = self.modules.iter().map(|module| module.path.as_slice());
        paths.filter_map(|path| match path {
            [name] => Some(name.as_str()),
            _ => None,
        })
    }

    /// Reads a file and those of its modules, which lie in `folder`.
    fn read_file(
        &mut self,
        workspace: &Path,
        file: &Path,
        path: Vec<String>,
        folder: &Path,
    ) -> anyhow::Result<()> {
        let name = file.strip_prefix(workspace).unwrap_or(file);
        let name = name.to_string_lossy().replace('\\', "/");
        let text =
            std::fs::read_to_string(file).with_context(|| format!("{name} cannot be read"))?;
        let syntax = syn::parse_file(&text).with_context(|| format!("{name} cannot be parsed"))?;
        self.files.push(name);
        let index = self.files.len() - 1;
        self.add(
            workspace,
            index,
            path,
            folder,
            collect::content(&syntax.items),
        )
    }

    /// Adds a module and all below it.
    fn add(
        &mut self,
        workspace: &Path,
        file: usize,
        path: Vec<String>,
        folder: &Path,
        mut content: Content,
    ) -> anyhow::Result<()> {
        let (inline, in_files) = (
            std::mem::take(&mut content.inline),
            std::mem::take(&mut content.in_files),
        );
        let below = |name: &String| [path.as_slice(), std::slice::from_ref(name)].concat();
        let inner: Vec<_> = inline
            .into_iter()
            .map(|(name, content)| (below(&name), folder.join(&name), content))
            .collect();
        let outer: Vec<_> = in_files
            .iter()
            .map(|name| Ok((below(name), file_of(folder, name)?, folder.join(name))))
            .collect::<anyhow::Result<_>>()
            .with_context(|| self.files[file].clone())?;
        self.modules.push(Module {
            path,
            file,
            content,
        });
        for (path, folder, content) in inner {
            self.add(workspace, file, path, &folder, content)?;
        }
        for (path, file, folder) in outer {
            self.read_file(workspace, &file, path, &folder)?;
        }
        Ok(())
    }
}

/// The file of `mod name;` in a module whose files lie in `folder`.
fn file_of(folder: &Path, name: &str) -> anyhow::Result<PathBuf> {
    let candidates = [
        folder.join(format!("{name}.rs")),
        folder.join(name).join("mod.rs"),
    ];
    let found = candidates.into_iter().find(|file| file.exists());
    ensure!(found.is_some(), "module `{name}` has no file");
    found.context("a module without a file")
}
