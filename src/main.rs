//! The `glint` program: everything is in the library.

fn main() -> std::process::ExitCode {
    glint::cli::main()
}
