//! One page that holds all of a comparison and needs no network: pictures are embedded, and so are script and style.

#[cfg(test)]
mod browser;
mod page;
mod table;
mod template;
mod viewer;

pub use page::page;
