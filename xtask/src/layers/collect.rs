//! The names that a module defines, imports and mentions. Tests are left out.

use proc_macro2::{Ident, Span, TokenStream, TokenTree};
use std::collections::{HashMap, HashSet};
use syn::punctuated::Punctuated;
use syn::visit::{self, Visit};
use syn::{Attribute, Item, Meta, Token, UseTree, Visibility};

/// How a module knows another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// `use path;`.
    Import,
    /// `pub use path;`: a name is handed on. That alone is no knowledge of what is behind it.
    HandedOn,
    /// A path in code.
    Code,
}

/// A path as it is written.
pub(super) struct Mention {
    pub(super) path: Vec<String>,
    /// The line, from 1.
    pub(super) line: usize,
    pub(super) kind: Kind,
}

/// The names of one module.
#[derive(Default)]
pub(super) struct Content {
    pub(super) mentions: Vec<Mention>,
    /// Imported names, each with the path it stands for.
    pub(super) aliases: HashMap<String, Vec<String>>,
    /// Paths of which all names are imported.
    pub(super) globs: Vec<Vec<String>>,
    /// Names defined here; modules too.
    pub(super) items: HashSet<String>,
    /// Modules within the braces of this one.
    pub(super) inline: Vec<(String, Content)>,
    /// Modules that have files of their own.
    pub(super) in_files: Vec<String>,
}

/// Collects the names of a module.
pub(super) fn content(items: &[Item]) -> Content {
    let mut content = Content::default();
    items.iter().for_each(|item| content.visit_item(item));
    content
}

impl<'ast> Visit<'ast> for Content {
    fn visit_item(&mut self, item: &'ast Item) {
        let (attributes, name) = attributes_and_name(item);
        if attributes.iter().any(is_for_tests) {
            return;
        }
        self.items.extend(name);
        visit::visit_item(self, item);
    }

    fn visit_impl_item_fn(&mut self, function: &'ast syn::ImplItemFn) {
        if !function.attrs.iter().any(is_for_tests) {
            visit::visit_impl_item_fn(self, function);
        }
    }

    fn visit_item_mod(&mut self, module: &'ast syn::ItemMod) {
        let name = module.ident.to_string();
        match &module.content {
            Some((_, items)) => self.inline.push((name, content(items))),
            None => self.in_files.push(name),
        }
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        if item.leading_colon.is_none() {
            let kind = match item.vis {
                Visibility::Inherited => Kind::Import,
                _ => Kind::HandedOn,
            };
            self.add_use(&item.tree, &mut Vec::new(), kind);
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        if let (None, Some(first)) = (&path.leading_colon, path.segments.first()) {
            let names = path
                .segments
                .iter()
                .map(|segment| segment.ident.to_string());
            self.add_mention(names.collect(), first.ident.span(), Kind::Code);
        }
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &'ast syn::Macro) {
        visit::visit_macro(self, call);
        self.add_tokens(call.tokens.clone());
    }

    /// `pub(super)` names no other code.
    fn visit_visibility(&mut self, _: &'ast Visibility) {}

    fn visit_attribute(&mut self, _: &'ast Attribute) {}
}

impl Content {
    /// Adds the leaves of a `use`.
    fn add_use(&mut self, tree: &UseTree, path: &mut Vec<String>, kind: Kind) {
        match tree {
            UseTree::Path(part) => {
                path.push(part.ident.to_string());
                self.add_use(&part.tree, path, kind);
                path.pop();
            }
            UseTree::Group(group) => {
                let inner = group.items.iter();
                inner.for_each(|tree| self.add_use(tree, path, kind));
            }
            UseTree::Glob(glob) => {
                self.globs.push(path.clone());
                self.add_mention(path.clone(), glob.star_token.spans[0], kind);
            }
            UseTree::Name(leaf) => self.add_leaf(path, &leaf.ident, &leaf.ident, kind),
            UseTree::Rename(leaf) => self.add_leaf(path, &leaf.ident, &leaf.rename, kind),
        }
    }

    fn add_leaf(&mut self, path: &[String], name: &Ident, alias: &Ident, kind: Kind) {
        let mut full = path.to_vec();
        let mut alias = alias.to_string();
        match path.last() {
            // `use a::b::{self}` brings in `b`.
            Some(last) if name == "self" => {
                if alias == "self" {
                    alias.clone_from(last);
                }
            }
            _ => full.push(name.to_string()),
        }
        self.aliases.insert(alias, full.clone());
        self.add_mention(full, name.span(), kind);
    }

    fn add_mention(&mut self, path: Vec<String>, span: Span, kind: Kind) {
        let line = span.start().line;
        self.mentions.push(Mention { path, line, kind });
    }

    /// Adds the paths among a macro's tokens, which are not parsed.
    fn add_tokens(&mut self, tokens: TokenStream) {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let mut i = 0;
        while i < tokens.len() {
            match &tokens[i] {
                TokenTree::Group(group) => self.add_tokens(group.stream()),
                TokenTree::Ident(first) => {
                    let path = path_at(&tokens, i);
                    let end = i + 3 * (path.len() - 1);
                    if begins_path(&tokens[..i], first) {
                        self.add_mention(path, first.span(), Kind::Code);
                    }
                    i = end;
                }
                _ => {}
            }
            i += 1;
        }
    }
}

/// The names from token `i` on that two colons each join.
fn path_at(tokens: &[TokenTree], mut i: usize) -> Vec<String> {
    let mut path = Vec::new();
    while let Some(TokenTree::Ident(name)) = tokens.get(i) {
        path.push(name.to_string());
        if !(is_punct(tokens.get(i + 1), ':') && is_punct(tokens.get(i + 2), ':')) {
            break;
        }
        i += 3;
    }
    path
}

/// False for fields, methods, variables of macros and what follows two colons.
fn begins_path(before: &[TokenTree], first: &Ident) -> bool {
    let last = before.last();
    let last_but_one = before.len().checked_sub(2).and_then(|i| before.get(i));
    let is_variable = is_punct(last, '$') && first != "crate";
    let is_inner = is_punct(last, ':') && is_punct(last_but_one, ':');
    !(is_punct(last, '.') || is_variable || is_inner)
}

fn is_punct(token: Option<&TokenTree>, character: char) -> bool {
    matches!(token, Some(TokenTree::Punct(p)) if p.as_char() == character)
}

/// True of `#[test]`, and of a `#[cfg(..)]` that only tests fulfil.
fn is_for_tests(attribute: &Attribute) -> bool {
    let path = attribute.path();
    if path.is_ident("cfg") {
        return attribute
            .parse_args::<Meta>()
            .is_ok_and(|condition| needs_test(&condition));
    }
    path.segments
        .last()
        .is_some_and(|last| last.ident == "test")
}

fn needs_test(condition: &Meta) -> bool {
    match condition {
        Meta::Path(path) => path.is_ident("test"),
        Meta::List(list) if list.path.is_ident("all") => list
            .parse_args_with(Punctuated::<Meta, Token![,]>::parse_terminated)
            .is_ok_and(|all| all.iter().any(needs_test)),
        _ => false,
    }
}

/// The attributes of an item, and the name it defines.
fn attributes_and_name(item: &Item) -> (&[Attribute], Option<String>) {
    macro_rules! named {
        ($item:expr, $name:expr) => {
            ($item.attrs.as_slice(), Some($name.to_string()))
        };
    }
    match item {
        Item::Const(i) => named!(i, i.ident),
        Item::Enum(i) => named!(i, i.ident),
        Item::Fn(i) => named!(i, i.sig.ident),
        Item::Mod(i) => named!(i, i.ident),
        Item::Static(i) => named!(i, i.ident),
        Item::Struct(i) => named!(i, i.ident),
        Item::Trait(i) => named!(i, i.ident),
        Item::Type(i) => named!(i, i.ident),
        Item::Union(i) => named!(i, i.ident),
        Item::Macro(i) => (&i.attrs, i.ident.as_ref().map(Ident::to_string)),
        Item::Impl(i) => (&i.attrs, None),
        Item::Use(i) => (&i.attrs, None),
        Item::ExternCrate(i) => (&i.attrs, None),
        _ => (&[], None),
    }
}
