//! `#[derive(Describe)]`: a component's fields, each told once.
//!
//! ```ignore
//! /// A ring about Oy.
//! #[derive(Component, Clone, Default, Describe)]
//! struct Torus {
//!     /// Radius of the ring, object units.
//!     #[describe(positive, required)]
//!     major: f64,
//!     /// Radius of the tube, object units.
//!     #[describe(within(1e-9, 1e9), required)]
//!     minor: f64,
//! }
//! ```
//!
//! The name of the struct is the tag; the doc comment of a field says what it means to whoever reads the scene's faults or
//! sees the field in an editor; the attribute lists functions of `Spec`, the first of which makes it (`any`, if none
//! does). The type tells how the field is read: a type that is no number, vector, colour, file or list of them must be a
//! `Choice`.
//!
//! | attribute | of | means |
//! |---|---|---|
//! | `tag = "Box"` | the struct | another tag than its name |
//! | `check = path` | the struct | the function that checks the fields against each other: `Describe::check` |
//! | `name = "strength"` | a field | another name than its own; a field of a tuple struct must have one |
//! | `about = "…"` | a field | another meaning than the doc comment says |

use proc_macro::TokenStream;
use proc_macro2::{Span, TokenStream as Tokens};
use quote::{ToTokens, quote, quote_spanned};
use syn::{
    Attribute, Data, DeriveInput, Error, Expr, Field, GenericArgument, Ident, LitStr, Meta, PathArguments, Result,
    Token, Type, punctuated::Punctuated, spanned::Spanned,
};

/// Derives `Describe`: see [the crate](crate).
#[proc_macro_derive(Describe, attributes(describe))]
pub fn describe(input: TokenStream) -> TokenStream {
    let input = syn::parse_macro_input!(input as DeriveInput);
    expand(&input).unwrap_or_else(Error::into_compile_error).into()
}

fn expand(input: &DeriveInput) -> Result<Tokens> {
    let Data::Struct(data) = &input.data else {
        return Err(Error::new(
            input.ident.span(),
            "only a struct has fields to describe; words of a choice: `choice!`",
        ));
    };
    let mut tag = LitStr::new(&input.ident.to_string(), input.ident.span());
    let mut check = None;
    for item in items(&input.attrs)? {
        match item {
            Item::Is(name, value) if name == "tag" => tag = text(&value)?,
            Item::Is(name, value) if name == "check" => check = Some(value),
            other => return Err(Error::new(other.span(), "expected `tag = \"…\"` or `check = path`")),
        }
    }
    let fields: Vec<_> =
        data.fields.iter().enumerate().map(|(number, field)| one(number, field)).collect::<Result<_>>()?;
    let check = check.map(|check| {
        quote_spanned! { check.span() =>
            fn check(&self) -> ::core::result::Result<(), ::snell::components::describe::Fault> {
                #check(self)
            }
        }
    });
    let (ident, (impl_generics, type_generics, bounds)) = (&input.ident, input.generics.split_for_impl());
    Ok(quote! {
        #[automatically_derived]
        impl #impl_generics ::snell::components::describe::Describe for #ident #type_generics #bounds {
            const TAG: &'static str = #tag;

            fn describe(&mut self, fields: &mut dyn ::snell::components::describe::FieldVisitor) {
                use ::snell::components::describe::{Spec, Value};
                #(#fields)*
            }

            #check
        }
    })
}

/// The call that shows a field.
fn one(number: usize, field: &Field) -> Result<Tokens> {
    let mut name = field.ident.as_ref().map(|ident| LitStr::new(&ident.to_string(), ident.span()));
    let mut about = meaning(&field.attrs);
    let (mut spec, mut changes) = (None, vec![]);
    for item in items(&field.attrs)? {
        match item {
            Item::Is(key, value) if key == "name" => name = Some(text(&value)?),
            Item::Is(key, value) if key == "about" => about = Some(text(&value)?),
            Item::Is(key, _) => return Err(Error::new(key.span(), "expected `name` or `about`")),
            Item::Call(function, arguments) if MAKE.iter().any(|make| function == make) => {
                if spec.is_some() || !changes.is_empty() {
                    return Err(Error::new(function.span(), "the range comes first, and once"));
                }
                spec = Some((function, arguments));
            }
            Item::Call(function, arguments) => changes.push(quote! { .#function(#arguments) }),
        }
    }
    let span = field.ty.span();
    let name = name.ok_or_else(|| Error::new(span, "expected `#[describe(name = \"…\")]`: the field has none"))?;
    let about = about
        .ok_or_else(|| Error::new(span, format!("expected a doc comment that says what `{}` means", name.value())))?;
    let (make, arguments) = spec.unwrap_or_else(|| (Ident::new("any", Span::call_site()), Punctuated::new()));
    let arguments = arguments.iter().map(|argument| quote! { #argument, });
    let place = match &field.ident {
        Some(ident) => ident.to_token_stream(),
        None => syn::Index::from(number).to_token_stream(),
    };
    let value = Ident::new(kind(&field.ty), Span::call_site());
    Ok(quote_spanned! { span =>
        fields.field(#name, Value::#value(&mut self.#place), Spec::#make(#(#arguments)* #about) #(#changes)*);
    })
}

/// The functions of `Spec` that make one.
const MAKE: [&str; 4] = ["any", "within", "not_negative", "positive"];

/// What stands between the brackets of an attribute.
enum Item {
    Is(Ident, Box<Expr>),
    Call(Ident, Punctuated<Expr, Token![,]>),
}

impl Item {
    fn span(&self) -> Span {
        let (Self::Is(name, _) | Self::Call(name, _)) = self;
        name.span()
    }
}

/// Everything in the `describe` attributes, in order.
fn items(attributes: &[Attribute]) -> Result<Vec<Item>> {
    let mut all = vec![];
    for attribute in attributes.iter().filter(|attribute| attribute.path().is_ident("describe")) {
        for meta in attribute.parse_args_with(Punctuated::<Meta, Token![,]>::parse_terminated)? {
            let name = meta.path().require_ident()?.clone();
            all.push(match meta {
                Meta::Path(_) => Item::Call(name, Punctuated::new()),
                Meta::List(list) => Item::Call(name, list.parse_args_with(Punctuated::parse_terminated)?),
                Meta::NameValue(pair) => Item::Is(name, Box::new(pair.value)),
            });
        }
    }
    Ok(all)
}

/// A text in quotes.
fn text(value: &Expr) -> Result<LitStr> {
    syn::parse2(value.to_token_stream()).map_err(|_| Error::new(value.span(), "expected a text in quotes"))
}

/// The doc comment as a phrase: without links and the full stop, and not with a capital unless its first word has more of
/// them.
fn meaning(attributes: &[Attribute]) -> Option<LitStr> {
    let line = |attribute: &Attribute| {
        let Meta::NameValue(pair) = &attribute.meta else { return None };
        pair.path.is_ident("doc").then(|| text(&pair.value).ok()).flatten()
    };
    let lines: Vec<_> = attributes.iter().filter_map(line).collect();
    let span = lines.first()?.span();
    let words: Vec<_> = lines.iter().map(LitStr::value).collect();
    let words = words.iter().flat_map(|line| line.split_whitespace()).collect::<Vec<_>>().join(" ");
    let words = words.replace("[`", "`").replace("`]", "`");
    let words = words.strip_suffix('.').unwrap_or(&words);
    let mut letters = words.chars();
    let first = letters.next()?;
    let word = letters.as_str().split(' ').next().unwrap_or_default();
    let phrase = if word.chars().any(char::is_uppercase) {
        words.to_owned()
    } else {
        first.to_lowercase().chain(letters).collect()
    };
    Some(LitStr::new(&phrase, span))
}

/// The variant of `Value` that holds a type, by its name: a colour is a vector that means something else.
fn kind(of: &Type) -> &'static str {
    let (name, inner) = last(of);
    match (name.as_str(), inner.as_deref()) {
        ("f64", _) => "Number",
        ("u32", _) => "Integer",
        ("bool", _) => "Bool",
        ("DVec3", _) => "Vector",
        ("Rgb", _) => "Color",
        ("Option", Some("f64")) => "OptionalNumber",
        ("Option", Some("DVec3")) => "OptionalVector",
        ("Vec", Some("DVec3")) => "Vectors",
        ("Vec", Some("DVec2")) => "Vectors2",
        ("SmallVec", _) => "Steps",
        ("Asset", Some("TriangleMesh")) => "Model",
        ("Asset", Some("Image")) => "Image",
        _ => "Choice",
    }
}

/// The last word of a type's path, and that of what it is of.
fn last(of: &Type) -> (String, Option<String>) {
    let Type::Path(path) = of else { return (String::new(), None) };
    let Some(segment) = path.path.segments.last() else { return (String::new(), None) };
    let inner = match &segment.arguments {
        PathArguments::AngleBracketed(arguments) => arguments.args.iter().find_map(|argument| match argument {
            GenericArgument::Type(inner) => Some(last(inner).0),
            _ => None,
        }),
        _ => None,
    };
    (segment.ident.to_string(), inner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use syn::parse_quote;

    fn fault(input: DeriveInput) -> String {
        expand(&input).expect_err("a fault").to_string()
    }

    #[test]
    fn a_field_becomes_the_call_that_one_would_write() {
        let input = parse_quote! {
            struct Ring {
                /// Radius of the ring,
                /// object units.
                #[describe(within(1e-9, 1e9), required)]
                major: f64,
            }
        };
        let expected = quote! {
            fields.field(
                "major",
                Value::Number(&mut self.major),
                Spec::within(1e-9, 1e9, "radius of the ring, object units").required()
            );
        };
        let found = expand(&input).expect("sound").to_string();
        assert!(found.contains(&expected.to_string()), "{found}");
        assert!(found.contains(r#"const TAG : & 'static str = "Ring" ;"#), "{found}");
        assert!(!found.contains("fn check"), "{found}");
    }

    #[test]
    fn types_tell_how_a_field_is_read() {
        let kinds: [(Type, &str); 9] = [
            (parse_quote!(f64), "Number"),
            (parse_quote!(Option<f64>), "OptionalNumber"),
            (parse_quote!(glam::DVec3), "Vector"),
            (parse_quote!(Option<DVec3>), "OptionalVector"),
            (parse_quote!(Vec<DVec2>), "Vectors2"),
            (parse_quote!(Rgb), "Color"),
            (parse_quote!(SmallVec<[Step; 4]>), "Steps"),
            (parse_quote!(Asset<Image>), "Image"),
            (parse_quote!(Shading), "Choice"),
        ];
        for (of, expected) in kinds {
            assert_eq!(kind(&of), expected, "{}", of.to_token_stream());
        }
    }

    #[test]
    fn names_of_things_keep_their_capitals() {
        let phrase = |text: &str| meaning(&[parse_quote!(#[doc = #text])]).map(|phrase| phrase.value());
        assert_eq!(phrase(" Of the tube.").as_deref(), Some("of the tube"));
        assert_eq!(phrase(" RGB, linear.").as_deref(), Some("RGB, linear"));
        assert_eq!(phrase(" A point.").as_deref(), Some("a point"));
        assert_eq!(phrase(" `ks`, linear RGB.").as_deref(), Some("`ks`, linear RGB"));
        assert_eq!(phrase(" As [`Camera::step`] does.").as_deref(), Some("as `Camera::step` does"));
        assert_eq!(phrase(""), None);
    }

    #[test]
    fn what_is_amiss_is_said() {
        assert!(fault(parse_quote! { enum Side { Left } }).contains("only a struct"));
        assert!(fault(parse_quote! { struct A { b: f64 } }).contains("a doc comment that says what `b` means"));
        assert!(fault(parse_quote! { struct A(#[doc = "B."] f64); }).contains("expected `#[describe(name = \"…\")]`"));
        assert!(fault(parse_quote! { #[describe(tga = "B")] struct A; }).contains("expected `tag"));
        assert!(fault(parse_quote! { #[describe(tag = 3)] struct A; }).contains("a text in quotes"));
        let twice = parse_quote! { struct A { #[doc = "B."] #[describe(positive, within(0.0, 1.0))] b: f64 } };
        assert!(fault(twice).contains("comes first, and once"));
        let late = parse_quote! { struct A { #[doc = "B."] #[describe(required, positive)] b: f64 } };
        assert!(fault(late).contains("comes first, and once"));
        let key = parse_quote! { struct A { #[doc = "B."] #[describe(nmae = "b")] b: f64 } };
        assert!(fault(key).contains("expected `name` or `about`"));
    }
}
