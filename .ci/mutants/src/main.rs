//! Lists the mutants of a crate: small changes to its source, one a line, as JSON.
//!
//! `mutants src/lib.rs` follows the `mod` declarations from that file. Tests, constants, macros, attributes and the
//! implementations of `Debug` and `Display` have no mutants.

mod changes;

use std::collections::HashMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use serde_json::json;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{Attribute, Expr, ImplItem, Item, ItemImpl, ItemMod, Pat, Signature, Stmt, Type};

use changes::{Change, Form};

fn main() {
    let root = std::env::args_os().nth(1).expect("usage: mutants src/lib.rs");
    visit_file(Path::new(&root));
}

fn visit_file(path: &Path) {
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let file = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let stem = path.file_stem().expect("a file");
    let parent = path.parent().expect("a folder");
    let is_folder = ["lib", "main", "mod"].iter().any(|name| stem == *name);
    let modules = if is_folder { parent.to_owned() } else { parent.join(stem) };
    let mut walk =
        Walk { path, text: &text, modules, scope: Vec::new(), seen: HashMap::new(), files: Vec::new() };
    walk.visit_file(&file);
    walk.files.iter().for_each(|file| visit_file(file));
}

/// Walk through one file.
struct Walk<'a> {
    path: &'a Path,
    text: &'a str,
    /// Folder of the files of its modules.
    modules: PathBuf,
    /// Names of the types and functions around the current node.
    scope: Vec<String>,
    /// Number of equal changes in functions of the same name.
    seen: HashMap<[String; 4], usize>,
    /// Files of the modules declared so far.
    files: Vec<PathBuf>,
}

impl Walk<'_> {
    /// Prints the change of the text in `range`.
    fn print(&mut self, range: Range<usize>, change: Change) {
        let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        let (original, function) = (words(&self.text[range.clone()]), self.scope.join("::"));
        let mutated = words(&change.text);
        let key = [function.clone(), change.kind.to_owned(), original.clone(), mutated.clone()];
        let occurrence = self.seen.entry(key).or_default();
        *occurrence += 1;
        let line = self.text[..range.start].matches('\n').count() + 1;
        let site = json!({
            "file": self.path, "line": line, "function": function, "kind": change.kind, "form": change.form.name(),
            "original": original, "mutated": mutated, "occurrence": *occurrence, "start": range.start, "end": range.end,
            "text": change.text,
        });
        println!("{site}");
    }

    fn print_all(&mut self, node: &impl Spanned, changes: Vec<Change>) {
        changes.into_iter().for_each(|change| self.print(node.span().byte_range(), change));
    }

    fn within(&mut self, name: String, visit: impl FnOnce(&mut Self)) {
        self.scope.push(name);
        visit(self);
        self.scope.pop();
    }

    /// Visits a function that runs at run time.
    fn function(&mut self, attributes: &[Attribute], signature: &Signature, body: &syn::Block) {
        if signature.constness.is_some() || is_test(attributes) {
            return;
        }
        self.within(signature.ident.to_string(), |walk| {
            if !body.stmts.is_empty() {
                let start = body.brace_token.span.open().byte_range().end;
                changes::of_function(signature)
                    .into_iter()
                    .for_each(|change| walk.print(start..start, change));
            }
            walk.visit_block(body);
        });
    }
}

impl<'ast> Visit<'ast> for Walk<'_> {
    fn visit_item(&mut self, item: &'ast Item) {
        match item {
            Item::Fn(item) => self.function(&item.attrs, &item.sig, &item.block),
            Item::Trait(item) => {
                self.within(item.ident.to_string(), |walk| visit::visit_item_trait(walk, item));
            }
            Item::Impl(item) => self.visit_item_impl(item),
            Item::Mod(item) => self.visit_item_mod(item),
            _ => {}
        }
    }

    fn visit_item_mod(&mut self, module: &'ast ItemMod) {
        if is_test(&module.attrs) {
            return;
        }
        let name = module.ident.to_string();
        if module.content.is_none() {
            let file = self.modules.join(format!("{name}.rs"));
            let folder = self.modules.join(name).join("mod.rs");
            self.files.push(if file.exists() { file } else { folder });
            return;
        }
        self.modules.push(&name);
        visit::visit_item_mod(self, module);
        self.modules.pop();
    }

    fn visit_item_impl(&mut self, item: &'ast ItemImpl) {
        let is_printing = item.trait_.as_ref().is_some_and(|(path, _)| {
            path.segments.last().is_some_and(|last| last.ident == "Debug" || last.ident == "Display")
        });
        if is_printing || is_test(&item.attrs) {
            return;
        }
        let name = match &*item.self_ty {
            Type::Path(path) => path.path.segments.last().map(|last| last.ident.to_string()),
            _ => None,
        };
        self.within(name.unwrap_or_else(|| "impl".to_owned()), |walk| {
            item.items.iter().for_each(|item| walk.visit_impl_item(item));
        });
    }

    fn visit_impl_item(&mut self, item: &'ast ImplItem) {
        if let ImplItem::Fn(item) = item {
            self.function(&item.attrs, &item.sig, &item.block);
        }
    }

    fn visit_trait_item(&mut self, item: &'ast syn::TraitItem) {
        if let syn::TraitItem::Fn(syn::TraitItemFn { attrs, sig, default: Some(body), .. }) = item {
            self.function(attrs, sig, body);
        }
    }

    fn visit_stmt(&mut self, statement: &'ast Stmt) {
        if changes::is_skippable(statement) {
            self.print_all(statement, vec![Change::new("statement", Form::Statement, "")]);
        }
        visit::visit_stmt(self, statement);
    }

    fn visit_expr(&mut self, expression: &'ast Expr) {
        self.print_all(expression, changes::of_expression(expression, self.text));
        match expression {
            Expr::If(branch) if changes::is_negatable(&branch.cond) => {
                self.print_all(&*branch.cond, vec![changes::negated(&branch.cond, self.text)]);
                visit::visit_expr(self, expression);
            }
            // The length of an array is a constant.
            Expr::Repeat(array) => self.visit_expr(&array.expr),
            // Dropping the minus is change enough.
            Expr::Unary(minus) if matches!(*minus.expr, Expr::Lit(_)) => {}
            Expr::Const(_) => {}
            _ => visit::visit_expr(self, expression),
        }
    }

    fn visit_pat(&mut self, pattern: &'ast Pat) {
        if let Pat::Guard(guarded) = pattern {
            if changes::is_negatable(&guarded.guard) {
                self.print_all(&*guarded.guard, vec![changes::negated(&guarded.guard, self.text)]);
            }
            self.visit_expr(&guarded.guard);
        }
    }

    fn visit_type(&mut self, _: &'ast Type) {}
    fn visit_angle_bracketed_generic_arguments(&mut self, _: &'ast syn::AngleBracketedGenericArguments) {}
    fn visit_generics(&mut self, _: &'ast syn::Generics) {}
    fn visit_attribute(&mut self, _: &'ast Attribute) {}
    fn visit_macro(&mut self, _: &'ast syn::Macro) {}
}

/// True for `#[test]` and `#[cfg(test)]`.
fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let is_cfg = attribute.path().is_ident("cfg");
        attribute.path().is_ident("test")
            || is_cfg && attribute.parse_args::<syn::Path>().is_ok_and(|condition| condition.is_ident("test"))
    })
}
