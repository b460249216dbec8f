//! What these readings cannot tell apart.
