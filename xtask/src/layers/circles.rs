//! Files that import each other in a circle.
//!
//! A module that only hands on what its children define makes no circle with them. One that uses them, while they use what
//! it defines, does.

use super::collect::Kind;
use super::resolve::Import;
use petgraph::algo::{astar, tarjan_scc};
use petgraph::graphmap::DiGraphMap;

type Graph<'a> = DiGraphMap<&'a str, &'a Import>;

/// The circles of files; each with the shortest way round and the imports that make it.
pub(super) fn problems(imports: &[Import]) -> Vec<String> {
    let graph = graph(imports);
    let circles = tarjan_scc(&graph);
    let mut problems: Vec<String> = circles
        .iter()
        .filter(|files| files.len() > 1)
        .map(|files| message(files, &shortest(&graph, files)))
        .collect();
    problems.sort_unstable();
    problems
}

/// Which file knows which, each by its first import.
fn graph(imports: &[Import]) -> Graph<'_> {
    let mut graph = Graph::new();
    for import in imports {
        let (from, to) = (import.from.as_str(), import.file.as_str());
        if from != to && import.kind != Kind::HandedOn && !graph.contains_edge(from, to) {
            graph.add_edge(from, to, import);
        }
    }
    graph
}

/// The imports of the shortest circle among files that all reach each other.
fn shortest<'a>(graph: &Graph<'a>, files: &[&'a str]) -> Vec<&'a Import> {
    let round = |from: &'a str, to: &'a str| {
        let (_, back) = astar(graph, to, |file| file == from, |_| 1, |_| 0)?;
        Some([vec![from], back].concat())
    };
    let circles = files
        .iter()
        .flat_map(|from| graph.neighbors(from).filter_map(move |to| round(from, to)));
    let circle = circles.min_by_key(|circle| (circle.len(), circle.clone()));
    let steps = circle.unwrap_or_default();
    let imports = steps
        .windows(2)
        .filter_map(|pair| graph.edge_weight(pair[0], pair[1]));
    imports.copied().collect()
}

fn message(files: &[&str], circle: &[&Import]) -> String {
    let mut text = format!(
        "{} files import each other in a circle; the shortest:",
        files.len()
    );
    for import in circle {
        let Import {
            from,
            line,
            path,
            file,
            ..
        } = import;
        text += &format!("\n  {from}:{line}: `{path}` is in {file}");
    }
    text
}
