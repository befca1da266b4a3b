//! The systems of Snell, in order.

pub mod load;
