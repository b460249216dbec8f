//! The whole search repeated without some poses.
