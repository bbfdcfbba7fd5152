//! Random robots, dense oracles and tolerances.
