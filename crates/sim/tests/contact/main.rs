//! Laws of robots that the ground or their own loops hold.

mod falling;
mod held;
mod refusals;
mod robots;
mod sliding;
mod standing;
