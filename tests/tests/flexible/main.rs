//! Laws of robots whose links bend.

mod dynamics;
mod energy;
mod limits;
mod oracles;
mod paper;
mod scratch;
