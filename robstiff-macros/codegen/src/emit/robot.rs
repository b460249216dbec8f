//! The generated type and its `Robot` implementation.

use proc_macro2::{Literal, Span, TokenStream};
use quote::{format_ident, quote};
use robstiff_robots::description::MOST_JOINTS;
use robstiff_robots::text::{shown, shown_in_line};
use robstiff_robots::words::count;
use robstiff_robots::{Description, JointKind, Place};
use syn::Ident;

use super::body::{Body, body, handing_over};
use super::bound::hidden;
use super::calculations::{Build, CALCULATIONS, Calculation, Generated, OF_SOME, compliance_entries};
use super::facts::{FACTS, Fact};
use super::reader::{Reader, number};
use super::signature::Signature;
use crate::function::{Cost, Function};
use crate::graph::NamedNumber;
use crate::symbolic;

/// Where generated code comes from and where it will stand.
#[derive(Clone, Debug)]
pub struct Origin {
    /// The description's file, as generated docs name it.
    pub file: String,
    /// The path to the runtime crate.
    pub runtime: TokenStream,
    /// The visibility of the generated type.
    pub visibility: TokenStream,
}

/// The items for one robot: the type, its constants, its implementation.
pub fn tokens(robot: &Description, origin: &Origin) -> TokenStream {
    let functions = Generated::all(robot);
    let definition = definition(robot, origin, &functions, Reader::Compiler);
    let imports = imports_of(robot, &origin.runtime);
    let implementation = implementation(robot, &functions, Reader::Compiler);
    let hidden = hidden(&implementation);
    quote! {
        #definition
        const _: () = {
            #imports
            #hidden
            #implementation
        };
    }
}

/// What stands in for a robot whose description is wrong: the type, the constants
/// that need no effects, and a `Robot` implementation without code, so that the
/// description's errors are the only ones. Who names a number of an effect is told
/// that there is none.
pub fn skeleton(name: &str, joints: Option<usize>, origin: &Origin) -> TokenStream {
    let Origin { runtime, visibility, .. } = origin;
    let name = Ident::new(name, Span::call_site());
    let (generics, count) = match joints {
        Some(joints) => {
            let joints = Literal::usize_unsuffixed(joints);
            (quote!(), quote!(#joints))
        }
        // No robot has an underscore in its name.
        None => (quote!(<const JOINT_COUNT: usize>), quote!(JOINT_COUNT)),
    };
    let methods: TokenStream = signatures()
        .map(|signature| {
            let signature = signature(&count);
            quote!(#signature { ::core::unimplemented!() })
        })
        .collect();
    // Also missing docs would be an error of their own.
    let doc = quote!(#[doc = " A robot whose description has mistakes."]);
    // Where the number of joints is unknown, a call of what does not depend on
    // it must not ask for it.
    let inherent = joints.is_none().then(|| {
        let facts = signatures().filter_map(|signature| {
            let [one, other] = [quote!(1), quote!(2)].map(|joints| signature(&joints));
            (one.to_string() == other.to_string()).then(|| quote!(#doc pub #one { ::core::unimplemented!() }))
        });
        quote!(impl #name { #(#facts)* })
    });
    let constants = constants_of_any(joints.unwrap_or(MOST_JOINTS));
    let costs = CALCULATIONS.iter().chain(&OF_SOME).map(|calculation| {
        let name = cost_of(calculation);
        quote!(#doc pub const #name: #runtime::Cost = #runtime::Cost { trig: 0, mul: 0, add: 0, neg: 0, root: 0 };)
    });
    let (imports, hidden, derived) = (imports(runtime, &[]), hidden(&methods), derived(Reader::Compiler));
    quote! {
        #doc
        #derived
        #visibility struct #name;
        const _: () = {
            #imports
            #hidden
            #inherent
            impl #name {
                #(#doc pub const #constants: f64 = 1.0;)*
                #(#costs)*
            }
            impl #generics Robot<#count> for #name {
                #methods
            }
        };
    }
}

/// The names of the numbers that a robot may have whose effects are not known.
fn constants_of_any(joints: usize) -> impl Iterator<Item = Ident> {
    const COLUMNS: [&str; 8] = ["THETA", "D", "A", "H", "SIN_THETA", "COS_THETA", "SIN_ALPHA", "COS_ALPHA"];
    let of_rows = (1..=joints).flat_map(|row| COLUMNS.map(|column| format_ident!("{column}{row}")));
    let of_places = ["BASE", "TOOL"].into_iter().flat_map(|place| {
        let along = ["X", "Y", "Z"].map(|axis| format_ident!("{place}_{axis}"));
        let turns =
            ["YAW", "PITCH", "ROLL"].into_iter().flat_map(|angle| ["SIN", "COS"].map(|function| (function, angle)));
        let turns = turns.map(move |(function, angle)| format_ident!("{function}_{place}_{angle}"));
        along.into_iter().chain([format_ident!("{place}_YAW")]).chain(turns)
    });
    of_rows.chain(of_places)
}

/// The name of the constant that has the operations of a calculation.
fn cost_of(calculation: &Calculation) -> Ident {
    format_ident!("{}_COST", calculation.name.to_uppercase())
}

/// The signatures of the methods of every robot, in the order of the trait.
fn signatures() -> impl Iterator<Item = Signature> {
    let calculations = CALCULATIONS.into_iter().map(|calculation| calculation.signature);
    FACTS.into_iter().map(|fact| fact.signature).chain(calculations)
}

/// What every implementation names, and `more` that this one does.
fn imports(runtime: &TokenStream, more: &[&str]) -> TokenStream {
    let mut names = ["Convention", "Effect", "JointKind", "Real", "Robot", "Statics"].to_vec();
    names.extend(more);
    names.sort_unstable();
    let names = names.into_iter().map(|name| Ident::new(name, Span::call_site()));
    // Beyond these, paths are whole: the user's file may go without a prelude,
    // or have an `Option` of its own.
    quote! {
        use #runtime::nalgebra::{Matrix4, Matrix6, SMatrix, SVector, Vector6};
        use #runtime::{#(#names),*};
    }
}

/// What the implementation of a robot names.
pub(super) fn imports_of(robot: &Description, runtime: &TokenStream) -> TokenStream {
    let mut more = Vec::new();
    if symbolic::remembers(robot) {
        more.push("State");
    }
    if robot.effects.iter().any(|effect| matches!(effect.place(), Place::Entry(_))) {
        more.push("DhEntry");
    }
    imports(runtime, &more)
}

/// The type with its documentation and its named numbers.
pub(super) fn definition(robot: &Description, origin: &Origin, functions: &[Generated], reader: Reader) -> TokenStream {
    let Origin { file, visibility, .. } = origin;
    let file = shown_in_line(file);
    let name = Ident::new(&robot.name, Span::call_site());
    let mut docs = Vec::new();
    if !robot.description.trim().is_empty() {
        docs.extend(paragraph(&robot.description));
    }
    let joints = count(robot.joints.len(), "joint");
    docs.push(format!(" Elastostatics of `{}`, {joints}, generated from `{file}`.", robot.name));
    docs.extend(parts(robot));
    if !robot.source.trim().is_empty() {
        docs.push(String::new());
        docs.push(" # Sources".to_owned());
        docs.push(String::new());
        docs.extend(lines(&robot.source));
    }
    let mut numbers: Vec<NamedNumber> = Vec::new();
    // In columns, numbers may have names that they have nowhere else.
    let written = functions.iter().flat_map(|generated| generated.written(reader));
    for named in written.flat_map(|function| function.graph().named_numbers().to_vec()) {
        if !numbers.contains(&named) {
            numbers.push(named);
        }
    }
    let constants = numbers.iter().map(|named| {
        let (doc, value) = (format!(" {}", named.doc), number(named.value, reader));
        let name = format_ident!("{}", named.name);
        quote! {
            #[doc = #doc]
            pub const #name: f64 = #value;
        }
    });
    let runtime = &origin.runtime;
    let costs = functions.iter().map(|generated| {
        let name = cost_of(&generated.method);
        let doc = format!(" Operations of `{}`.", generated.method.name);
        // Naming every field on both sides makes a field that only one type has a compile error.
        let Cost { trig, mul, add, neg, root } = generated.function.cost();
        let [trig, mul, add, neg, root] = [trig, mul, add, neg, root].map(Literal::usize_unsuffixed);
        quote! {
            #[doc = #doc]
            pub const #name: #runtime::Cost =
                #runtime::Cost { trig: #trig, mul: #mul, add: #add, neg: #neg, root: #root };
        }
    });
    let derived = derived(reader);
    // Nobody needs every constant.
    let allow = allow(reader, "dead_code");
    quote! {
        #(#[doc = #docs])*
        #derived
        #visibility struct #name;

        #allow
        impl #name {
            #(#constants)*
            #(#costs)*
        }
    }
}

/// What the type derives. Macros of other crates have the same names, and the user may have
/// imported one.
fn derived(reader: Reader) -> TokenStream {
    match reader {
        Reader::Compiler => quote! {
            #[derive(
                ::core::clone::Clone,
                ::core::marker::Copy,
                ::core::fmt::Debug,
                ::core::default::Default,
                ::core::cmp::PartialEq,
                ::core::cmp::Eq,
            )]
        },
        Reader::Person => quote!(#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]),
    }
}

/// The joints and the effects of a robot as docs, with the unit of its coordinates.
fn parts(robot: &Description) -> Vec<String> {
    let is_of = |kind: JointKind| robot.joints.iter().all(|joint| joint.kind == kind);
    let unit = match (is_of(JointKind::Revolute), is_of(JointKind::Prismatic)) {
        (true, _) => "rad",
        (false, true) => "m",
        (false, false) => "rad, of sliding joints in m",
    };
    let mut docs = ["", " # Joints", ""].map(str::to_owned).to_vec();
    docs.extend([format!(" Their coordinates `q` are in {unit}."), String::new()]);
    docs.extend((1..).zip(&robot.joints).map(|(number, joint)| {
        let kind = match joint.kind {
            JointKind::Revolute => "turns",
            JointKind::Prismatic => "slides",
        };
        let limits = match joint.limits.map(|limits| limits.map(|limit| joint.for_people(limit))) {
            Some([low, high]) => format!("from {low} to {high} {}", joint.people_unit()),
            None => "limits unknown".to_owned(),
        };
        format!(" {number}. {kind}, {limits}")
    }));
    if !robot.effects.is_empty() {
        docs.extend(["", " # Effects", ""].map(str::to_owned));
        docs.extend(robot.effects.iter().map(|effect| format!(" - `{effect}`: {}", effect.noun())));
    }
    docs
}

/// A paragraph of docs with an empty line after it.
fn paragraph(text: &str) -> Vec<String> {
    let mut out = lines(text);
    out.push(String::new());
    out
}

/// The lines of a description's text as docs, in which brackets are no links
/// and no tags, and fences begin no code, which would be run as a test.
fn lines(text: &str) -> Vec<String> {
    // A comment with a lone carriage return is no Rust.
    let escaped = text.trim().replace('\r', "\n").replace('[', "\\[").replace('<', "\\<");
    let escaped = escaped.replace("```", "\\`\\`\\`").replace("~~~", "\\~\\~\\~");
    // rustc refuses what turns the direction of a source file's text: it is spelled out.
    linked(&shown(&escaped)).lines().map(|line| format!(" {}", line.trim()).trim_end().to_owned()).collect()
}

/// A text whose addresses are links, for rustdoc warns of those that are none.
fn linked(text: &str) -> String {
    let (mut linked, mut rest) = (String::new(), text);
    while let Some(start) = ["https://", "http://"].into_iter().filter_map(|scheme| rest.find(scheme)).min() {
        let (before, from) = rest.split_at(start);
        let ends = |c: char| c.is_whitespace() || matches!(c, '<' | '>' | '[' | ']' | '\\' | '`' | '"');
        let whole = from.split(ends).next().unwrap_or(from);
        // A sentence's point is not the address's, nor is the end of a bracket that it is in.
        let is_after = |c: char| matches!(c, '.' | ',' | ';' | '!' | '?') || c == ')' && !whole.contains('(');
        let address = whole.trim_end_matches(is_after);
        // In backticks it is no link, and may stay as it is.
        let is_code = before.ends_with('`') && !before.ends_with("\\`");
        linked += before;
        linked += &if is_code { address.to_owned() } else { format!("<{address}>") };
        rest = &from[address.len()..];
    }
    linked + rest
}

/// The `Robot` implementation.
pub(super) fn implementation(robot: &Description, functions: &[Generated], reader: Reader) -> TokenStream {
    let name = Ident::new(&robot.name, Span::call_site());
    let n = Literal::usize_unsuffixed(robot.joints.len());
    let count = quote!(#n);
    let facts = FACTS.into_iter().map(|Fact { signature, value }| {
        let (signature, value) = (signature(&count), value(robot, reader));
        quote!(#[inline] #signature { #value })
    });
    let calculations = functions.iter().map(|generated| calculation(robot, generated, reader, &count));
    // People read the compliance once.
    let by_entries = (reader == Reader::Compiler).then(|| by_entries(robot, &count));
    // What a function does not depend on is unused.
    let allow = allow(reader, "unused_variables");
    quote! {
        #allow
        impl Robot<#n> for #name {
            #(#facts)*
            #(#calculations)*
            #by_entries
        }
    }
}

/// A method that calculates.
fn calculation(robot: &Description, generated: &Generated, reader: Reader, n: &TokenStream) -> TokenStream {
    let Generated { method, function, in_columns } = generated;
    let written = |function: &Function, result: Build| {
        let Body { statements, outputs } = body(function, reader);
        let result = result(robot, reader, &outputs);
        quote!(#statements #result)
    };
    let mut code = written(function, method.result);
    if let (Some((function, result)), Reader::Compiler) = (in_columns, reader) {
        let in_columns = written(function, *result);
        code = quote!(if T::COLUMNS { #in_columns } else { #code });
    }
    let mut docs = paragraph(&method.doc(robot));
    docs.push(format!(" {}.", function.cost()));
    let signature = (method.signature)(n);
    // Only a caller that sees the code can leave out what it does not
    // need, and compute several poses abreast.
    quote!(#(#[doc = #docs])* #[inline(always)] #signature { #code })
}

/// The method that hands over the compliance's entries one by one.
fn by_entries(robot: &Description, n: &TokenStream) -> TokenStream {
    let function = compliance_entries(robot);
    let statements = handing_over(&function);
    let mut docs = paragraph("Upper triangle of `compliance`, each entry as soon as it is known.");
    docs.push(format!(" {}.", function.cost()));
    quote! {
        #(#[doc = #docs])*
        #[inline(always)]
        fn compliance_entries<T: Real>(&self, q: &SVector<T, #n>, mut put: impl ::core::ops::FnMut(usize, T)) {
            #statements
        }
    }
}

/// What lints must not say of source for people: a limit of 180 degrees is no misspelt pi, and
/// something may be `unused`, in the words of a lint. In what a macro of another crate
/// expands to rustc does not look for that, and an `allow` is an error there if the user's
/// crate forbids the lint.
fn allow(reader: Reader, unused: &str) -> TokenStream {
    let unused = Ident::new(unused, Span::call_site());
    match reader {
        Reader::Compiler => quote!(),
        Reader::Person => quote!(#[allow(clippy::approx_constant, #unused)]),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use proc_macro2::TokenTree;
    use robstiff_robots::description::TAKEN;

    use super::*;

    /// A robot of such a name would be a second item of it.
    #[test]
    fn no_robot_is_named_as_what_its_code_imports() {
        let text = "name: Arm\nconvention: standard\njoints: [{a: 1 m, compliance: 1e-7 rad/Nm}]\neffects:\n  \
                    - {kind: hysteresis, at: joint 1, radius1: 1 Nm, weight1: 1e-8 rad/Nm}\n  \
                    - {kind: dh_error, at: a1, value: 1 mm}\n";
        let robot = Description::parse("arm.yaml", text).unwrap_or_else(|problems| panic!("{problems}"));
        let imports = imports_of(&robot, &quote!(robstiff)).into_iter();
        let lists =
            imports.filter_map(|token| if let TokenTree::Group(list) = token { Some(list.stream()) } else { None });
        let names = lists.flatten().filter(|token| matches!(token, TokenTree::Ident(_))).map(|name| name.to_string());
        let taken = TAKEN.into_iter().filter(|name| *name != "Self").map(str::to_owned);
        assert_eq!(names.collect::<BTreeSet<_>>(), taken.collect());
    }
}
