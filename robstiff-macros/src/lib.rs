//! The procedural macro behind `robstiff::robot!`: a thin shell around
//! [`robstiff_codegen`].
//!
//! It finds the description (module `locate`), has it read and checked, and hands it
//! to the generator. What is wrong with a description becomes one compile error
//! that shows the description's own lines, next to a skeleton of the type with the
//! constants that do not come of effects, so that hardly anything else fails because
//! of it.

mod input;
mod locate;

use proc_macro2::TokenStream;
use quote::quote;
use robstiff_codegen::{Origin, skeleton, tokens};
use robstiff_robots::Description;

use crate::input::Input;
use crate::locate::{Located, locate, with_ending};

/// Expands `[path to robstiff] visibility "file.yaml"`; `robstiff::robot!`
/// adds the path.
#[proc_macro]
pub fn robot(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    match syn::parse::<Input>(input) {
        Ok(input) => expand(&input),
        Err(error) => error.to_compile_error(),
    }
    .into()
}

fn expand(input: &Input) -> TokenStream {
    let Input { runtime, visibility, file } = input;
    let origin =
        |file: &str| Origin { file: file.to_owned(), runtime: runtime.clone(), visibility: quote!(#visibility) };
    let asked = with_ending(&file.value());
    let Located { shown, text, watched } = match locate(&asked, file.span()) {
        Ok(located) => located,
        Err(message) => return failed(input, &message, None, &origin(&asked)),
    };
    // The compiler has read the file: it will notice when it changes.
    let watch = watched.map(|path| {
        quote!(
            const _: &[u8] = ::core::include_bytes!(#path);
        )
    });
    let code = match Description::parse(&shown, &text) {
        Ok(robot) => tokens(&robot, &origin(&asked)),
        Err(diagnostics) => {
            let message = format!("the robot description has mistakes\n\n{diagnostics}");
            failed(input, &message, Some(&text), &origin(&asked))
        }
    };
    quote!(#watch #code)
}

/// The compile error, and a skeleton as near to the robot as can be known.
fn failed(input: &Input, message: &str, text: Option<&str>, origin: &Origin) -> TokenStream {
    let outline = text.map(Description::outline).unwrap_or_default();
    let name = outline.name.unwrap_or_else(|| input.type_name());
    let error = syn::Error::new(input.file.span(), message.trim_end()).to_compile_error();
    let skeleton = skeleton(&name, outline.joints, origin);
    quote!(#error #skeleton)
}
