//! Lets cortex-m-rt's `link.x` find `memory.x`.

fn main() {
    println!("cargo::rustc-link-search={}", std::env::var("CARGO_MANIFEST_DIR").expect("cargo runs this"));
    println!("cargo::rerun-if-changed=memory.x");
}
