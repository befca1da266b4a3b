//! Numbers that are the same in every run.

pub(crate) use snell::components::random::SplitMix64 as Random;
