"""Lab streaming layer (LSL): samples, poses and events go out as streams, and samples of any sensor come in."""
