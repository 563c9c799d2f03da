//! Lengths, indices and names, checked where a motion starts.
