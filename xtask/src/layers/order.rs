//! The declared order, as ARCHITECTURE.md writes it: a fenced block ```` ```layers CRATE ````, a line a layer, the lowest first.
//!
//! Modules that share a line, separated by commas, do not know each other. The crate's root stands above all and is not listed.

use anyhow::{bail, ensure};
use std::collections::BTreeMap;

/// The layers of one crate.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Order {
    /// The line of each top-level module, 0 for the lowest.
    layers: BTreeMap<String, usize>,
}

impl Order {
    /// The line of a top-level module, 0 for the lowest.
    pub(super) fn layer(&self, module: &str) -> Option<usize> {
        self.layers.get(module).copied()
    }

    /// Modules that are there and not listed, and the other way round.
    pub(super) fn mismatches(&self, modules: &[String]) -> Vec<String> {
        let unlisted = modules.iter().filter(|m| !self.layers.contains_key(*m));
        let gone = self.layers.keys().filter(|m| !modules.contains(m));
        unlisted
            .map(|m| format!("module `{m}` is in no layer"))
            .chain(gone.map(|m| format!("module `{m}` has a layer, and does not exist")))
            .collect()
    }
}

/// Reads the orders of all crates out of a document.
pub(super) fn parse(document: &str) -> anyhow::Result<BTreeMap<String, Order>> {
    let mut orders = BTreeMap::new();
    let mut lines = document.lines();
    while let Some(line) = lines.next() {
        let Some(name) = line.strip_prefix("```layers") else {
            continue;
        };
        let name = name.trim();
        ensure!(!name.is_empty(), "a block of layers names no crate");
        let order = parse_block(name, &mut lines)?;
        let before = orders.insert(name.to_owned(), order);
        ensure!(before.is_none(), "two blocks of layers for `{name}`");
    }
    ensure!(!orders.is_empty(), "no block of layers");
    Ok(orders)
}

fn parse_block<'a>(name: &str, lines: &mut impl Iterator<Item = &'a str>) -> anyhow::Result<Order> {
    let mut order = Order::default();
    for (layer, line) in lines.enumerate() {
        if line.trim_end() == "```" {
            return Ok(order);
        }
        for module in line.split(',').map(str::trim) {
            ensure!(
                !module.is_empty(),
                "an empty name in the layers of `{name}`"
            );
            let before = order.layers.insert(module.to_owned(), layer);
            ensure!(
                before.is_none(),
                "`{module}` is twice in the layers of `{name}`"
            );
        }
    }
    bail!("the block of layers of `{name}` has no end")
}
