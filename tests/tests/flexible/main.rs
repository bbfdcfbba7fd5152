//! Laws of robots whose links bend.

mod dynamics;
mod oracles;
