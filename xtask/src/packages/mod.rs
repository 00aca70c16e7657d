//! Tasks about packages that users install, and about their costs.

pub(crate) mod bare;
pub(crate) mod capi;
pub(crate) mod features;
pub(crate) mod fleet;
pub(crate) mod light;
pub(crate) mod package;
pub(crate) mod playground;
pub(crate) mod python;
pub(crate) mod release;
pub(crate) mod ros2;
pub(crate) mod sbom;
pub(crate) mod site;
