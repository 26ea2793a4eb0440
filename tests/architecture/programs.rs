//! The programs that a source file starts by name.

use std::collections::{BTreeMap, BTreeSet};
use syn::punctuated::Punctuated;
use syn::visit::{self, Visit};
use syn::{
    Expr, ExprCall, ExprMethodCall, FnArg, ImplItemFn, ItemConst, ItemFn, Lit, Local, Macro, Pat, Signature, Token,
};

/// Programs that tests may start although `tests/tools.txt` does not list them. Every Debian machine has the packages
/// bash, coreutils, dash and util-linux. The package binutils, which has `nm`, belongs to the compiler with which Rust
/// links.
pub const ALWAYS_THERE: [&str; 9] = ["bash", "cp", "env", "mkfifo", "nm", "sh", "timeout", "true", "unshare"];

/// Returns the programs that `tests/tools.txt` lists: those in its first column, and those that the shell commands in
/// its third column start.
pub fn listed(tools: &str) -> BTreeSet<String> {
    let lines = tools.lines().filter(|line| !line.starts_with('#'));
    let columns = lines.map(|line| line.split('|').map(str::trim).collect::<Vec<_>>());
    let programs = columns.filter(|columns| columns.len() == 3).flat_map(|columns| {
        let probes = columns[2].split("&&").filter_map(|probe| probe.split_whitespace().next());
        probes.chain([columns[0]]).collect::<Vec<_>>()
    });
    programs.map(str::to_owned).collect()
}

/// Returns the programs that a source file starts by name, without their folders: the literals and constants that it
/// passes to `Command::new`, directly or through parameters of its own functions and closures. A file that imports
/// `Command` as `Program` calls `Program::new` instead.
pub fn started(source: &str) -> BTreeSet<String> {
    if !["Command::new", "Program::new"].iter().any(|call| source.contains(call)) {
        return BTreeSet::new();
    }
    let mut calls = Calls::default();
    calls.visit_file(&syn::parse_file(source).expect("a source file"));
    calls.programs().iter().filter_map(|path| path.rsplit('/').next()).map(str::to_owned).collect()
}

/// A function or a closure with a name, and the place of a parameter.
type Parameter = (String, usize);

/// An argument of a call.
enum Argument {
    Text(String),
    /// A parameter of the function that makes the call.
    Parameter(Parameter),
    /// Another name, perhaps that of a constant.
    Name(String),
}

/// The calls of a source file.
#[derive(Default)]
struct Calls {
    /// The functions and closures around the present place, with the names of their parameters.
    around: Vec<(String, Vec<String>)>,
    /// Constants that are texts.
    constants: BTreeMap<String, String>,
    arguments: Vec<(Parameter, Argument)>,
}

impl Calls {
    fn programs(&self) -> BTreeSet<String> {
        let mut starting = BTreeSet::from([(COMMAND.to_owned(), 0)]);
        loop {
            let before = starting.len();
            for (parameter, argument) in &self.arguments {
                if let (true, Argument::Parameter(passed_on)) = (starting.contains(parameter), argument) {
                    starting.insert(passed_on.clone());
                }
            }
            if starting.len() == before {
                break;
            }
        }
        let programs = self.arguments.iter().filter(|(parameter, _)| starting.contains(parameter));
        let text = |argument: &Argument| match argument {
            Argument::Text(text) => Some(text.clone()),
            Argument::Name(name) => self.constants.get(name).cloned(),
            Argument::Parameter(_) => None,
        };
        programs.filter_map(|(_, argument)| text(argument)).collect()
    }

    fn note<'a>(&mut self, function: &str, arguments: impl IntoIterator<Item = &'a Expr>) {
        for (place, argument) in arguments.into_iter().enumerate() {
            if let Some(argument) = self.argument(argument) {
                self.arguments.push(((function.to_owned(), place), argument));
            }
        }
    }

    fn argument(&self, argument: &Expr) -> Option<Argument> {
        match argument {
            Expr::Reference(reference) => self.argument(&reference.expr),
            Expr::Lit(literal) => match &literal.lit {
                Lit::Str(text) => Some(Argument::Text(text.value())),
                _ => None,
            },
            Expr::Path(path) => {
                let name = path.path.get_ident()?.to_string();
                let parameter = self.around.iter().rev().find_map(|(function, parameters)| {
                    let place = parameters.iter().position(|parameter| *parameter == name)?;
                    Some((function.clone(), place))
                });
                Some(parameter.map_or(Argument::Name(name), Argument::Parameter))
            }
            _ => None,
        }
    }

    fn inside(&mut self, function: String, parameters: Vec<String>, look: impl FnOnce(&mut Self)) {
        self.around.push((function, parameters));
        look(self);
        self.around.pop();
    }
}

/// The function that starts programs, as `Calls` names it.
const COMMAND: &str = "Command::new";

impl<'ast> Visit<'ast> for Calls {
    fn visit_item_const(&mut self, constant: &'ast ItemConst) {
        if let Some(Argument::Text(text)) = self.argument(&constant.expr) {
            self.constants.insert(constant.ident.to_string(), text);
        }
        visit::visit_item_const(self, constant);
    }

    fn visit_item_fn(&mut self, function: &'ast ItemFn) {
        let (name, parameters) = named(&function.sig);
        self.inside(name, parameters, |calls| visit::visit_item_fn(calls, function));
    }

    fn visit_impl_item_fn(&mut self, function: &'ast ImplItemFn) {
        let (name, parameters) = named(&function.sig);
        self.inside(name, parameters, |calls| visit::visit_impl_item_fn(calls, function));
    }

    fn visit_local(&mut self, local: &'ast Local) {
        match local.init.as_ref().map(|init| &*init.expr) {
            Some(Expr::Closure(closure)) => {
                let parameters = closure.inputs.iter().map(name_of).collect();
                self.inside(name_of(&local.pat), parameters, |calls| visit::visit_local(calls, local));
            }
            _ => visit::visit_local(self, local),
        }
    }

    fn visit_expr_call(&mut self, call: &'ast ExprCall) {
        if let Expr::Path(path) = &*call.func {
            let names: Vec<String> = path.path.segments.iter().map(|segment| segment.ident.to_string()).collect();
            let function = match &names[..] {
                [.., of, new] if ["Command", "Program"].contains(&of.as_str()) && new == "new" => COMMAND,
                names => names.last().map_or("", String::as_str),
            };
            self.note(function, &call.args);
        }
        visit::visit_expr_call(self, call);
    }

    fn visit_expr_method_call(&mut self, call: &'ast ExprMethodCall) {
        self.note(&call.method.to_string(), &call.args);
        visit::visit_expr_method_call(self, call);
    }

    /// Looks into the macros whose arguments are expressions, for example `assert!`.
    fn visit_macro(&mut self, called: &'ast Macro) {
        let arguments = called.parse_body_with(Punctuated::<Expr, Token![,]>::parse_terminated);
        arguments.iter().flatten().for_each(|argument| Visit::visit_expr(self, argument));
    }
}

/// The name of a function and the names of its parameters. The receiver of a method does not count.
fn named(signature: &Signature) -> (String, Vec<String>) {
    let parameters = signature.inputs.iter().filter_map(|input| match input {
        FnArg::Typed(parameter) => Some(name_of(&parameter.pat)),
        FnArg::Receiver(_) => None,
    });
    (signature.ident.to_string(), parameters.collect())
}

/// The name that a pattern binds, or an empty text.
fn name_of(pattern: &Pat) -> String {
    match pattern {
        Pat::Ident(name) => name.ident.to_string(),
        Pat::Type(typed) => name_of(&typed.pat),
        _ => String::new(),
    }
}
