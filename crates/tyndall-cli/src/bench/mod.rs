//! `tyndall bench`: the papers' tables, measured on this machine.
//!
//! A suite runs the techniques of its paper that are in the table of techniques, and lists the others as missing.
//! Every ratio is one of two times of one run, frame by frame in turn.

mod billeter;
mod fit;
mod lin;
mod paper;
mod poses;
mod report;
mod scaling;
mod subject;
mod suites;
mod table;
#[cfg(test)]
mod tests;
mod wyman_dai;
mod yusov;

pub(crate) use suites::{run, suite_names};
