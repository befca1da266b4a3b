//! Stage 6.
