//! What the macro is given.

use proc_macro2::TokenStream;
use robstiff_robots::Description;
use syn::parse::{Parse, ParseStream};
use syn::{LitStr, Token, Visibility, bracketed};

/// `[path to robstiff] visibility "file.yaml"`, with a comma behind it or not.
pub(crate) struct Input {
    /// How the calling crate reaches robstiff: `$crate` of a macro in it, which
    /// is right whatever the user calls the dependency.
    pub runtime: TokenStream,
    /// The visibility of the generated type; public where nothing is said.
    pub visibility: Visibility,
    /// The description's file.
    pub file: LitStr,
}

impl Parse for Input {
    fn parse(input: ParseStream) -> syn::Result<Self> {
        let path;
        bracketed!(path in input);
        let runtime = path.parse()?;
        let visibility = match input.parse()? {
            Visibility::Inherited => Visibility::Public(syn::token::Pub::default()),
            given => given,
        };
        let file = input.parse().map_err(|error| {
            syn::Error::new(error.span(), "expected a description's file, e.g. robot!(\"rv130hsc.yaml\")")
        })?;
        input.parse::<Option<Token![,]>>()?;
        if !input.is_empty() {
            return Err(input.error("expected nothing after the file's name"));
        }
        Ok(Self { runtime, visibility, file })
    }
}

impl Input {
    /// A name for the type when the description does not give one: the file's,
    /// in upper camel case.
    pub fn type_name(&self) -> String {
        let file = self.file.value();
        let stem = file.rsplit(['/', '\\']).next().unwrap_or_default();
        let stem = stem.split('.').next().unwrap_or_default();
        Description::name_like(stem)
    }
}
