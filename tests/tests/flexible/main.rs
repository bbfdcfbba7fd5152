//! Laws of robots whose links bend.

mod closed_forms;
mod defects;
mod dynamics;
mod energy;
mod limits;
mod oracles;
mod paper;
mod scratch;
