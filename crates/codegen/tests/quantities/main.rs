//! Laws of everything that is generated: it is what the library computes.

mod bending;
mod derivatives;
mod elastic;
mod library;
mod regrouped;
mod rigid;
mod scratch;
mod subject;
mod unavailable;
