//! Laws of robots that the ground, their own loops or couplings hold.

mod bounces;
mod energy;
mod feet;
mod held;
mod impacts;
mod loops;
mod machines;
mod pinned;
mod refusals;
mod rotors;
mod slides;
mod stands;
mod start;
mod steps;
