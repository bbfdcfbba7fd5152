//! The inverse of elastic robots and the controllers around it. One program, since the inverse is compiled for every number of
//! coefficients.

mod control;
mod laws;
mod oracles;
mod smoothness;
