//! Wyman and Dai 2013: samples of an area light one by one and all at once, stage by stage; several scenes; and the cost
//! against one hard shadow volume.

mod costs;
mod run;
mod scenes;
mod steps;
mod suite;

pub(super) use run::run;
pub(super) use suite::AreaLights;
