//! How methods are declared.

use proc_macro2::TokenStream;

/// The signature of a method of `Robot`, for a number of joints.
pub(super) type Signature = fn(&TokenStream) -> TokenStream;
