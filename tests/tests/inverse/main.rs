//! The inverse of elastic robots and the controllers around it. One program, since the inverse is compiled for every number of
//! coefficients.

mod control;
mod laws;
mod open_loop;
mod oracles;
mod smoothness;
