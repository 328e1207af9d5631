//! Reading modules: their imports and what they declare. Declarations begin at the start of a line.

/// What an `import` statement names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Import {
    /// Path of the module, `tyndall::physics::medium`.
    pub(super) module: String,
    /// What is imported of it.
    pub(super) name: String,
    /// Line of the statement, from 1.
    pub(super) line: usize,
}

/// The imports of a module whose path begins with `package`, and its text with their lines emptied.
pub(super) fn split_imports(text: &str, package: &str) -> Result<(Vec<Import>, String), usize> {
    let mut imports = Vec::new();
    let mut rest = String::with_capacity(text.len());
    let mut lines = text.lines().enumerate();
    while let Some((index, line)) = lines.next() {
        if let Some(first) = line.strip_prefix("import ") {
            let mut statement = first.to_owned();
            while !statement.contains(';') {
                let (_, next) = lines.next().ok_or(index + 1)?;
                statement.push_str(next);
                rest.push('\n');
            }
            let (tree, _) = statement.split_once(';').ok_or(index + 1)?;
            let tree: String = tree.split_whitespace().collect();
            for path in flatten(&tree) {
                let (module, name) = path.rsplit_once("::").ok_or(index + 1)?;
                let module = match module.strip_prefix("package::") {
                    Some(inner) => format!("{package}::{inner}"),
                    None => module.to_owned(),
                };
                imports.push(Import {
                    module,
                    name: name.to_owned(),
                    line: index + 1,
                });
            }
        } else {
            rest.push_str(line);
        }
        rest.push('\n');
    }
    Ok((imports, rest))
}

/// The paths of an import tree, `a::{b, c::{d, e}}`.
fn flatten(tree: &str) -> Vec<String> {
    let Some((prefix, inner)) = tree
        .split_once('{')
        .and_then(|(prefix, rest)| Some((prefix, rest.strip_suffix('}')?)))
    else {
        return vec![tree.to_owned()];
    };
    let mut depth = 0;
    let parts = inner.split(|c| {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        c == ',' && depth == 0
    });
    let filled = parts.filter(|part| !part.is_empty());
    filled
        .flat_map(flatten)
        .map(|path| format!("{prefix}{path}"))
        .collect()
}

/// A line without its comment.
pub(super) fn code(line: &str) -> &str {
    line.split_once("//").map_or(line, |(code, _)| code)
}

/// The identifiers of a text, in order.
pub(super) fn identifiers(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
        .filter(|word| word.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_'))
}

/// The name that a line declares for its whole module, if it does.
pub(super) fn declared(line: &str) -> Option<&str> {
    const KEYWORDS: [&str; 6] = ["fn", "struct", "const", "override", "alias", "var"];
    if !line.starts_with(|c: char| c.is_ascii_alphabetic() || c == '@') {
        return None;
    }
    let line = code(line);
    let mut words = identifiers(line);
    let keyword = words.find(|word| KEYWORDS.contains(word))?;
    if keyword == "var" {
        // `var<storage, read> name`: what stands in the angle brackets is no name.
        let (_, after) = line.split_once("var")?;
        let after = match after.strip_prefix('<') {
            Some(space) => space.split_once('>')?.1,
            None => after,
        };
        return identifiers(after).next();
    }
    words.next()
}
