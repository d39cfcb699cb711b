//! Verification that shares no predicate with the engine.
