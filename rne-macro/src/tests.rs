//! Tests the expansion of the derives without the compiler.

use proc_macro2::{TokenStream, TokenTree};
use quote::quote;

use rne_codegen::Capability;

fn inverse_dynamics(input: TokenStream) -> TokenStream {
    crate::expand::capability(Capability::InverseDynamics, input)
}

/// Formats an expansion almost as rustfmt does.
fn pretty(expansion: TokenStream) -> String {
    let file = syn::parse2(expansion).expect("the expansion is a list of items");
    // the path of this checkout must not be in a snapshot
    prettyplease::unparse(&file).replace(env!("CARGO_MANIFEST_DIR"), "…")
}

#[test]
fn the_one_link_robot_of_the_lecture() {
    let expansion = inverse_dynamics(quote! {
        #[robot(path = "../robots/planar1.yaml")]
        pub struct OneLink;
    });
    insta::assert_snapshot!(pretty(expansion));
}

#[test]
fn what_stands_in_for_an_unknown_robot() {
    let expansion = inverse_dynamics(quote! {
        #[robot(yaml = "joints: [{dh: 1}, {dh: 2}]", crate = crate::dynamics)]
        struct Arm<'a, T>(&'a T) where T: Copy;
    });
    let code = pretty(expansion);
    let (_, stub) = code.split_once("#[automatically_derived]").expect("an implementation behind the message");
    insta::assert_snapshot!(stub);
}

/// Returns how many tokens an expansion has, which the compiler must read.
fn tokens(stream: TokenStream) -> usize {
    let count = |tree| match tree {
        TokenTree::Group(group) => 2 + tokens(group.stream()),
        _ => 1,
    };
    stream.into_iter().map(count).sum()
}

/// Limits the size of an expansion, on which the time of compilation depends, for the seven-joint arm with the longest
/// code.
#[test]
fn an_expansion_is_short() {
    let input = quote! {
        #[robot(path = "../robots/panda.yaml")]
        pub struct Panda;
    };
    let expansion = inverse_dynamics(input);
    assert!(!expansion.to_string().contains("compile_error"));
    let tokens = tokens(expansion);
    println!("expansion of panda.yaml: {tokens} tokens");
    // six methods, three of them with the whole recursion and one with a payload in addition
    assert!(tokens <= 32_000, "{tokens} tokens");
}

#[test]
fn every_mistake_of_an_attribute_is_reported() {
    let expansion = inverse_dynamics(quote! {
        #[robot(pfad = "x.yaml", form = 7, max_ops = -1, crate = 3, yaml = "", path)]
        struct Arm;
    });
    let code = pretty(expansion);
    let (messages, _) = code.split_once("#[automatically_derived]").expect("an implementation behind the messages");
    insta::assert_snapshot!(messages);
}
