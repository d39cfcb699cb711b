//! Triangulation of pieces.
