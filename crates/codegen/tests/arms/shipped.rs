//! Robots of the project, their numbers by hand.
