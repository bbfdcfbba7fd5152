//! Laws of everything that is generated: it is what the library computes.

mod bending;
mod bending_derivatives;
mod derivatives;
mod elastic;
mod library;
mod linearization;
mod regrouped;
mod rigid;
mod scratch;
mod shipped;
mod slopes;
mod subject;
mod unavailable;
