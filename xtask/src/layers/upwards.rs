//! Imports that go up in the declared order.

use super::order::Order;
use super::resolve::Import;
use std::collections::HashSet;

/// The imports that name, or lead to, a module that is not below: of each file the first to each other file.
pub(super) fn problems(imports: &[Import], order: &Order) -> Vec<String> {
    let mut known = HashSet::new();
    let mut sorted: Vec<&Import> = imports.iter().collect();
    sorted.sort_by_key(|import| (&import.from, import.line));
    let mut problems = Vec::new();
    for import in sorted {
        if let Some(why) = problem(import, order)
            && known.insert((&import.from, &import.file, why.clone()))
        {
            let Import {
                from, line, path, ..
            } = import;
            problems.push(format!("{from}:{line}: `{path}`: {why}"));
        }
    }
    problems
}

fn problem(import: &Import, order: &Order) -> Option<String> {
    // The root stands above all: it may know everything, and nothing may know it.
    let from = import.from_top.as_ref()?;
    let tops = [&import.named_top, &import.top];
    tops.into_iter().find_map(|top| match top {
        None => Some(format!("the crate's root is above `{from}`")),
        Some(top) if top == from => None,
        Some(top) => {
            let (here, there) = (order.layer(from)?, order.layer(top)?);
            match there.cmp(&here) {
                std::cmp::Ordering::Less => None,
                std::cmp::Ordering::Equal => Some(format!("`{top}` is beside `{from}`")),
                std::cmp::Ordering::Greater => Some(format!("`{top}` is above `{from}`")),
            }
        }
    })
}
