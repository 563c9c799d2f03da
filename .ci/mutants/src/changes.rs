//! Changes of one node of a syntax tree.

use syn::spanned::Spanned;
use syn::{BinOp, Expr, ExprBinary, Lit, ReturnType, Signature, Stmt, Type, UnOp};

/// Where the changed text goes.
pub(crate) enum Form {
    /// It replaces an expression.
    Value,
    /// It replaces a statement.
    Statement,
    /// It precedes the statements of a function.
    Return,
}

impl Form {
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Value => "value",
            Self::Statement => "statement",
            Self::Return => "return",
        }
    }
}

/// A mutant of one node.
pub(crate) struct Change {
    pub(crate) kind: &'static str,
    pub(crate) form: Form,
    /// New text.
    pub(crate) text: String,
}

impl Change {
    pub(crate) fn new(kind: &'static str, form: Form, text: impl Into<String>) -> Self {
        Self { kind, form, text: text.into() }
    }

    fn value(kind: &'static str, text: impl Into<String>) -> Self {
        Self::new(kind, Form::Value, text)
    }
}

/// Methods that are exchanged.
const METHODS: [[&str; 2]; 6] = [
    ["all", "any"],
    ["first", "last"],
    ["is_none", "is_some"],
    ["max", "min"],
    ["max_by", "min_by"],
    ["sin", "cos"],
];

/// Changes of an expression, not of the parts of it.
pub(crate) fn of_expression(expression: &Expr, text: &str) -> Vec<Change> {
    match expression {
        Expr::Binary(binary) if !has_let(expression) => of_operator(binary, text),
        Expr::Unary(unary) => match unary.op {
            UnOp::Neg(_) => vec![Change::value("minus", source(&*unary.expr, text))],
            UnOp::Not(_) => vec![Change::value("not", source(&*unary.expr, text))],
            _ => Vec::new(),
        },
        Expr::Lit(literal) => of_literal(&literal.lit).into_iter().collect(),
        Expr::MethodCall(call) => {
            let name = call.method.to_string();
            let Some(pair) = METHODS.iter().find(|pair| pair.contains(&&*name)) else { return Vec::new() };
            let other = if pair[0] == name { pair[1] } else { pair[0] };
            let (whole, method) = (expression.span().byte_range(), call.method.span().byte_range());
            let (before, after) = (&text[whole.start..method.start], &text[method.end..whole.end]);
            vec![Change::value("method", format!("{before}{other}{after}"))]
        }
        Expr::Call(call) => match &*call.func {
            Expr::Path(path) if path.path.is_ident("Some") => vec![Change::value("none", "None")],
            _ => Vec::new(),
        },
        _ => Vec::new(),
    }
}

fn of_operator(binary: &ExprBinary, text: &str) -> Vec<Change> {
    let others: &[(&'static str, &str)] = match binary.op {
        BinOp::Add(_) => &[("arithmetic", "-")],
        BinOp::Sub(_) => &[("arithmetic", "+")],
        BinOp::Mul(_) => &[("arithmetic", "/")],
        BinOp::Div(_) => &[("arithmetic", "*")],
        BinOp::AddAssign(_) => &[("arithmetic", "-=")],
        BinOp::SubAssign(_) => &[("arithmetic", "+=")],
        BinOp::MulAssign(_) => &[("arithmetic", "/=")],
        BinOp::DivAssign(_) => &[("arithmetic", "*=")],
        BinOp::And(_) => &[("logic", "||")],
        BinOp::Or(_) => &[("logic", "&&")],
        BinOp::BitAnd(_) => &[("logic", "|")],
        BinOp::BitOr(_) => &[("logic", "&")],
        BinOp::Eq(_) => &[("comparison", "!=")],
        BinOp::Ne(_) => &[("comparison", "==")],
        BinOp::Lt(_) => &[("boundary", "<="), ("comparison", ">=")],
        BinOp::Le(_) => &[("boundary", "<"), ("comparison", ">")],
        BinOp::Gt(_) => &[("boundary", ">="), ("comparison", "<=")],
        BinOp::Ge(_) => &[("boundary", ">"), ("comparison", "<")],
        _ => &[],
    };
    let (left, right) = (source(&*binary.left, text), source(&*binary.right, text));
    others
        .iter()
        .map(|(kind, operator)| Change::value(kind, format!("({left}) {operator} ({right})")))
        .collect()
}

fn of_literal(literal: &Lit) -> Option<Change> {
    let text = match literal {
        Lit::Int(number) => {
            let next = number.base10_parse::<u64>().ok()?.checked_add(1)?;
            format!("{next}{}", number.suffix())
        }
        Lit::Float(number) if number.base10_parse().is_ok_and(|x: f64| x == 0.0) => {
            format!("1.0{}", number.suffix())
        }
        Lit::Float(number) => format!("-{number}"),
        Lit::Bool(flag) => (!flag.value).to_string(),
        _ => return None,
    };
    Some(Change::value("literal", text))
}

/// Early returns of a function.
pub(crate) fn of_function(signature: &Signature) -> Vec<Change> {
    let values: &[&str] = match &signature.output {
        ReturnType::Default => &[""],
        ReturnType::Type(_, of) => match &**of {
            Type::Path(path) => match path.path.segments.last().map(|last| last.ident.to_string()).as_deref()
            {
                Some("bool") => &["true", "false"],
                Some("Option") => &["None"],
                Some("Result") => &["Ok(())"],
                _ => &[],
            },
            _ => &[],
        },
    };
    values.iter().map(|value| Change::new("return", Form::Return, format!("return {value};"))).collect()
}

/// True for a statement without a value: an assignment or a call.
pub(crate) fn is_skippable(statement: &Stmt) -> bool {
    let Stmt::Expr(expression, Some(_)) = statement else { return false };
    match expression {
        Expr::Assign(_) | Expr::Call(_) | Expr::MethodCall(_) => true,
        Expr::Try(call) => matches!(*call.expr, Expr::Call(_) | Expr::MethodCall(_)),
        Expr::Binary(binary) => matches!(
            binary.op,
            BinOp::AddAssign(_) | BinOp::SubAssign(_) | BinOp::MulAssign(_) | BinOp::DivAssign(_)
        ),
        _ => false,
    }
}

/// True for a condition that no other change negates.
pub(crate) fn is_negatable(condition: &Expr) -> bool {
    let is_compared =
        matches!(condition, Expr::Binary(binary) if !matches!(binary.op, BinOp::And(_) | BinOp::Or(_)));
    !is_compared && !has_let(condition) && !matches!(condition, Expr::Unary(_) | Expr::Lit(_))
}

pub(crate) fn negated(condition: &Expr, text: &str) -> Change {
    Change::value("condition", format!("!({})", source(condition, text)))
}

/// True for a chain of conditions with `let`, which is no expression by itself.
fn has_let(condition: &Expr) -> bool {
    match condition {
        Expr::Let(_) => true,
        Expr::Binary(binary) => has_let(&binary.left) || has_let(&binary.right),
        _ => false,
    }
}

fn source<'a>(node: &impl Spanned, text: &'a str) -> &'a str {
    &text[node.span().byte_range()]
}
