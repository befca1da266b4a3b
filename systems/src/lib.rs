//! The systems of Snell, in the order in which they run.

pub mod registry;

pub mod load;
