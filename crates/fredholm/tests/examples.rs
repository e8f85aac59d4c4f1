//! Every example runs, and ends with the numbers that it asserts.

/// A test for each example, of its file's name.
macro_rules! examples {
    ($($name:ident: $path:literal,)*) => {
        $(
            #[path = $path]
            mod $name;

            #[test]
            fn $name() -> Result<(), Box<dyn std::error::Error>> {
                $name::main()
            }
        )*

        const EXAMPLES: &[&str] = &[$($path),*];
    };
}

examples! {
    quadrature: "../examples/01_quadrature.rs",
    methods: "../examples/02_methods.rs",
    automatic: "../examples/03_automatic.rs",
    singular_kernels: "../examples/04_singular_kernels.rs",
    alternative: "../examples/05_alternative.rs",
    neumann: "../examples/06_neumann.rs",
    spectrum: "../examples/07_spectrum.rs",
    plane: "../examples/08_plane.rs",
    system: "../examples/09_system.rs",
    hierarchical: "../examples/10_hierarchical.rs",
}

#[test]
fn none_is_left_out() -> std::io::Result<()> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/examples");
    assert_eq!(std::fs::read_dir(folder)?.count(), EXAMPLES.len());
    Ok(())
}
