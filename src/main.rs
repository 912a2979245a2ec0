//! `orthocert`: the command line.

fn main() -> std::process::ExitCode {
    orthocert::cli::main()
}
