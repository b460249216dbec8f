//! The names that code binds, kept apart from what the user's module has under them.
//!
//! A name in a pattern is a new variable only where no constant, static or unit struct
//! of that name is in scope: beside a `const t1` the line `let t1 = ..;` is a pattern that
//! may fail. Spans do not help: to a macro's variables a module's constants are visible
//! with [`Span::mixed_site`](proc_macro2::Span::mixed_site), too. But a variable may have the
//! name of a function, and what a block imports hides what is outside of it.

use std::collections::BTreeSet;

use proc_macro2::{Delimiter, Ident, Spacing, TokenStream, TokenTree};
use quote::quote;

/// For the block that code is in: a function under every name that the code binds. rustc does
/// not warn that they are unused, since they come from another crate's macro.
pub(super) fn hidden(code: &TokenStream) -> TokenStream {
    let mut names = BTreeSet::new();
    collect(code, Place::Other, &mut names);
    quote!(use ::core::mem::{#(drop as #names),*};)
}

/// What tokens are.
#[derive(Clone, Copy, PartialEq)]
enum Place {
    /// Between `let` and `=`.
    Pattern,
    /// In parentheses.
    Parentheses,
    Other,
}

/// What is in patterns, and the parameters of functions, which have a colon behind them.
fn collect(code: &TokenStream, place: Place, names: &mut BTreeSet<Ident>) {
    let mut at = place;
    let mut tokens = code.clone().into_iter().peekable();
    while let Some(token) = tokens.next() {
        match token {
            TokenTree::Ident(word) if word == "let" => at = Place::Pattern,
            TokenTree::Ident(word) if word == "_" || word == "mut" => {}
            TokenTree::Ident(name) => {
                // The colons of a path are joint.
                let has_type = matches!(tokens.peek(), Some(TokenTree::Punct(colon))
                    if colon.as_char() == ':' && colon.spacing() == Spacing::Alone);
                if at == Place::Pattern || (at == Place::Parentheses && has_type) {
                    names.insert(name);
                }
            }
            TokenTree::Punct(sign) if sign.as_char() == '=' => at = place,
            TokenTree::Group(group) => {
                let inside = match group.delimiter() {
                    _ if at == Place::Pattern => Place::Pattern,
                    Delimiter::Parenthesis => Place::Parentheses,
                    _ => Place::Other,
                };
                collect(&group.stream(), inside, names);
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variables_and_parameters_are_bound() {
        let code = quote! {
            fn statics<T: Real>(&self, q: &SVector<T, 5>, mut put: impl ::core::ops::FnMut(usize, T)) -> Statics<5, T> {
                let [_, (s1, c1), [tt_xx, _]] = T::sin_cos_of_sums(q, |q| [q[0], x]);
                let t1 = s1 * Self::A1;
                if T::COLUMNS { let t2 = -t1; }
                Statics { transform: t1, jacobian: f(t2) }
            }
        };
        let mut names = BTreeSet::new();
        collect(&code, Place::Other, &mut names);
        let names: Vec<String> = names.iter().map(Ident::to_string).collect();
        assert_eq!(names, ["c1", "put", "q", "s1", "t1", "t2", "tt_xx"]);
    }
}
