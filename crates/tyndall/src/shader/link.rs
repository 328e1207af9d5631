//! Joining modules into plain WGSL.

use std::{
    borrow::Cow,
    collections::{BTreeMap, BTreeSet, HashMap},
};

use super::{
    package::modules,
    scan::{declared, split_imports},
};

/// Why modules could not be linked.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LinkError {
    /// There is no module of this path.
    #[error("{by}: there is no module `{path}`")]
    NoModule {
        /// Where it is imported, `engine::fog:3`, or the caller.
        by: String,
        /// The path.
        path: String,
    },
    /// The module does not declare the name.
    #[error("{by}: `{module}` does not declare `{name}`")]
    NoName {
        /// Where it is imported, `engine::fog:3`.
        by: String,
        /// The module.
        module: String,
        /// The name.
        name: String,
    },
    /// An import statement cannot be read.
    #[error(
        "{at}: expected `import package::module::name;` or `import package::module::{{name, name}};`"
    )]
    Syntax {
        /// Where it stands, `engine::fog:3`.
        at: String,
    },
    /// Two modules that are linked together declare the same name.
    #[error("both `{first}` and `{second}` declare `{name}`")]
    Clash {
        /// The name.
        name: String,
        /// One module.
        first: String,
        /// The other.
        second: String,
    },
}

/// Links modules of the package and of others.
#[derive(Clone, Debug)]
pub struct Linker<'a> {
    modules: BTreeMap<Cow<'a, str>, Cow<'a, str>>,
    /// Bind groups of the package that go elsewhere.
    groups: BTreeMap<u32, u32>,
}

/// Plain WGSL, and where it came from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Linked {
    /// The text.
    pub wgsl: String,
    /// The modules in it, each with the number of its first line, from 1.
    pub modules: Vec<(usize, String)>,
}

impl Linked {
    /// True where a module in the text declares this name.
    pub fn declares(&self, name: &str) -> bool {
        self.wgsl.lines().filter_map(declared).any(|d| d == name)
    }

    /// The module and the line there of a line of the text, from 1.
    pub fn origin(&self, line: usize) -> Option<(&str, usize)> {
        let (first, path) = self
            .modules
            .iter()
            .rev()
            .find(|(first, _)| *first <= line)?;
        Some((path, line - first + 1))
    }
}

impl Default for Linker<'_> {
    fn default() -> Self {
        Self::new()
    }
}

impl<'a> Linker<'a> {
    /// Knows the modules of the package.
    pub fn new() -> Self {
        let modules = modules()
            .iter()
            .map(|(path, text)| ((*path).into(), (*text).into()));
        Self {
            modules: modules.collect(),
            groups: BTreeMap::new(),
        }
    }

    /// Adds a module, or puts it in the place of another. The first name of its path is its package.
    #[must_use]
    pub fn module(mut self, path: impl Into<Cow<'a, str>>, text: impl Into<Cow<'a, str>>) -> Self {
        self.modules.insert(path.into(), text.into());
        self
    }

    /// Has bind group `from` of the package, 0 (frame) or 1 (light), bound as `to`.
    #[must_use]
    pub fn group(mut self, from: u32, to: u32) -> Self {
        self.groups.insert(from, to);
        self
    }

    /// The module of this path with all that it imports, itself last.
    ///
    /// # Errors
    /// Where a module or a name is missing, or two of the modules declare the same name.
    pub fn link(&self, root: &str) -> Result<Linked, LinkError> {
        let mut linking = Linking {
            linker: self,
            seen: BTreeSet::new(),
            declared_by: HashMap::new(),
            linked: Linked {
                wgsl: String::new(),
                modules: Vec::new(),
            },
            lines: 0,
        };
        linking.add(root, "the caller")?;
        Ok(linking.linked)
    }
}

struct Linking<'a> {
    linker: &'a Linker<'a>,
    seen: BTreeSet<String>,
    declared_by: HashMap<String, String>,
    linked: Linked,
    lines: usize,
}

impl Linking<'_> {
    fn add(&mut self, path: &str, by: &str) -> Result<(), LinkError> {
        let linker = self.linker;
        let text = linker
            .modules
            .get(path)
            .ok_or_else(|| LinkError::NoModule {
                by: by.to_owned(),
                path: path.to_owned(),
            })?;
        // Modules may import from each other: WGSL knows no order.
        if !self.seen.insert(path.to_owned()) {
            return Ok(());
        }
        let package = path.split("::").next().unwrap_or_default();
        let (imports, own) = split_imports(text, package).map_err(|line| LinkError::Syntax {
            at: format!("{path}:{line}"),
        })?;
        for import in imports {
            let by = format!("{path}:{}", import.line);
            self.add(&import.module, &by)?;
            let text = linker.modules.get(import.module.as_str());
            let declares = |text: &Cow<'_, str>| {
                text.lines()
                    .filter_map(declared)
                    .any(|name| name == import.name)
            };
            if !text.is_some_and(declares) {
                return Err(LinkError::NoName {
                    by,
                    module: import.module,
                    name: import.name,
                });
            }
        }
        self.append(path, package, &own)
    }

    fn append(&mut self, path: &str, package: &str, own: &str) -> Result<(), LinkError> {
        for name in own.lines().filter_map(declared) {
            if let Some(first) = self.declared_by.insert(name.to_owned(), path.to_owned()) {
                return Err(LinkError::Clash {
                    name: name.to_owned(),
                    first,
                    second: path.to_owned(),
                });
            }
        }
        self.linked.modules.push((self.lines + 1, path.to_owned()));
        let moved = if package == "tyndall" {
            self.move_groups(own)
        } else {
            own.to_owned()
        };
        self.lines += moved.lines().count();
        self.linked.wgsl.push_str(&moved);
        Ok(())
    }

    fn move_groups(&self, text: &str) -> String {
        let move_line = |line: &str| {
            let found = self.linker.groups.iter().find_map(|(from, to)| {
                let (old, new) = (format!("@group({from})"), format!("@group({to})"));
                line.starts_with(&old).then(|| line.replacen(&old, &new, 1))
            });
            found.unwrap_or_else(|| line.to_owned()) + "\n"
        };
        text.lines().map(move_line).collect()
    }
}
