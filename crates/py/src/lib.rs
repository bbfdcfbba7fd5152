//! Python bindings of gyroflex.
