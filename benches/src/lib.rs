//! Robots and states shared by the benches.
