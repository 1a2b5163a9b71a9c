//! The syntax tree: an arena in which every child stands before its parent.
//!
//! All passes are loops over the arena, so the nesting of a formula is bounded by memory only, never by the call stack.
use super::{Axis, function::Builtin};
use num_rational::BigRational;
use std::{fmt, ops::Range};

/// Index into [`Tree`].
pub(crate) type AstId = u32;

/// A token whose names are resolved: what the grammar reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Token {
    Number(u32),
    Name(Symbol),
    Function(Callee),
    Superscript(u32),
    Plus,
    Minus,
    Times,
    Divide,
    Power,
    Root,
    Open,
    Close,
    Comma,
    Equals,
}

impl fmt::Display for Token {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Number(_) => "a number",
            Self::Name(_) => "a name",
            Self::Function(_) => "a function",
            Self::Superscript(_) => "a superscript",
            Self::Plus => "`+`",
            Self::Minus => "`-`",
            Self::Times => "`*`",
            Self::Divide => "`/`",
            Self::Power => "`^`",
            Self::Root => "`√`",
            Self::Open => "`(`",
            Self::Close => "`)`",
            Self::Comma => "`,`",
            Self::Equals => "`=`",
        })
    }
}

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Symbol {
    Axis(Axis),
    Pi,
    E,
    Phi,
    Tau,
    /// A constant that the user defined: index into [`Program::definitions`].
    User(u32),
    /// Parameter of the definition that is being read.
    Parameter(u32),
}

/// What a call calls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Callee {
    Builtin(Builtin),
    /// Index into [`Program::definitions`].
    User(u32),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Operation {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Ast {
    /// Index into [`Tree::numbers`].
    Number(u32),
    Name(Symbol),
    Negate(AstId),
    Root(AstId),
    Binary(Operation, AstId, AstId),
    /// Arguments are `Tree::arguments[first .. first + count]`.
    Call {
        callee: Callee,
        first: u32,
        count: u32,
    },
}

#[derive(Default)]
pub(crate) struct Tree {
    pub(crate) nodes: Vec<Ast>,
    pub(crate) spans: Vec<Range<u32>>,
    pub(crate) arguments: Vec<AstId>,
    pub(crate) numbers: Vec<BigRational>,
}

impl Tree {
    /// Byte positions fit `u32`: the source is at most 1 MiB long.
    fn push(&mut self, node: Ast, span: Range<usize>) -> AstId {
        let id = self.nodes.len() as AstId;
        self.nodes.push(node);
        self.spans.push(span.start as u32..span.end as u32);
        id
    }

    pub(crate) fn number(&mut self, index: u32, span: Range<usize>) -> AstId {
        self.push(Ast::Number(index), span)
    }

    pub(crate) fn name(&mut self, symbol: Symbol, span: Range<usize>) -> AstId {
        self.push(Ast::Name(symbol), span)
    }

    pub(crate) fn negate(&mut self, a: AstId, span: Range<usize>) -> AstId {
        self.push(Ast::Negate(a), span)
    }

    pub(crate) fn root(&mut self, a: AstId, span: Range<usize>) -> AstId {
        self.push(Ast::Root(a), span)
    }

    pub(crate) fn binary(&mut self, operation: Operation, a: AstId, b: AstId, span: Range<usize>) -> AstId {
        self.push(Ast::Binary(operation, a, b), span)
    }

    pub(crate) fn call(&mut self, callee: Callee, arguments: &[AstId], span: Range<usize>) -> AstId {
        let first = self.arguments.len() as u32;
        self.arguments.extend_from_slice(arguments);
        self.push(Ast::Call { callee, first, count: arguments.len() as u32 }, span)
    }

    pub(crate) fn span(&self, id: AstId) -> Range<usize> {
        let Range { start, end } = self.spans[id as usize];
        start as usize..end as usize
    }
}

/// One statement's part of the arena; its root is its last node.
#[derive(Clone, Debug)]
pub(crate) struct Body {
    pub(crate) nodes: Range<u32>,
    pub(crate) root: AstId,
}

/// A constant (`parameters` empty) or function that the user defined; it can name only earlier definitions.
pub(crate) struct Definition {
    pub(crate) name: String,
    pub(crate) function: bool,
    pub(crate) parameters: Vec<String>,
    pub(crate) body: Body,
}

/// A formula text, read: definitions in order, then the equation of the surface.
pub(crate) struct Program {
    pub(crate) tree: Tree,
    pub(crate) definitions: Vec<Definition>,
    pub(crate) equation: Body,
}
