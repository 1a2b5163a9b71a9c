//! Syntax tree -> graph.
//!
//! Calls of the user's functions are expanded: the body is read again with the arguments in place of the parameters, so that
//! a parameter can be a whole shape (`f(s) = translate(s, 1, 0, 0)`). A definition can name only earlier ones, so the stack of
//! open calls, kept on the heap, is never deeper than the number of definitions.
use super::{
    Error, ErrorKind, Graph, MAX_NODES, NodeId, Unary, exact,
    function::{Builtin, MANY},
    meaning,
    syntax::{Ast, AstId, Body, Callee, Operation, Program, Symbol},
};
use num_traits::Zero;
use std::ops::Range;

/// Most operations visited while definitions are expanded and shapes are transformed.
const MAX_STEPS: usize = 1 << 22;

/// A body that is being read.
struct Frame {
    body: Body,
    next: AstId,
    /// Values of the body's syntax nodes before `next`.
    values: Vec<NodeId>,
    arguments: Vec<NodeId>,
    /// Where in the source it was called from, for errors of the whole.
    span: Range<usize>,
}

impl Frame {
    fn new(body: &Body, arguments: Vec<NodeId>, span: Range<usize>) -> Self {
        Self { body: body.clone(), next: body.nodes.start, values: vec![], arguments, span }
    }

    fn value(&self, id: AstId) -> NodeId {
        self.values[(id - self.body.nodes.start) as usize]
    }
}

struct Lowering<'a> {
    source: &'a str,
    program: &'a Program,
    graph: Graph,
    steps: usize,
    /// Values of the user's constants so far, by definition.
    constants: Vec<Option<NodeId>>,
}

/// The graph of a program and its root.
pub(crate) fn lower(source: &str, program: &Program) -> Result<(Graph, NodeId), Error> {
    check_calls(source, program)?;
    let constants = vec![None; program.definitions.len()];
    let mut lowering = Lowering { source, program, graph: Graph::new(false), steps: 0, constants };
    for (i, definition) in program.definitions.iter().enumerate() {
        if !definition.function {
            let value = lowering.run(&definition.body)?;
            lowering.constants[i] = Some(value);
        }
    }
    let root = lowering.run(&program.equation)?;
    Ok((lowering.graph, root))
}

/// Every call, also in functions that are never used, has the right number of arguments.
fn check_calls(source: &str, program: &Program) -> Result<(), Error> {
    for (i, node) in program.tree.nodes.iter().enumerate() {
        let Ast::Call { callee, count, .. } = *node else { continue };
        let (name, (least, most)) = match callee {
            Callee::Builtin(f) => (f.name(), f.arity()),
            Callee::User(d) => {
                let d = &program.definitions[d as usize];
                (d.name.as_str(), (d.parameters.len() as u32, d.parameters.len() as u32))
            }
        };
        // `scale` takes one factor or three.
        let gap = callee == Callee::Builtin(Builtin::Scale) && count == 3;
        if count < least || count > most || gap {
            let plural = |n: u32| if n == 1 { "argument" } else { "arguments" };
            let wanted = match (least, most) {
                (2, 4) => "2 or 4 arguments".to_owned(),
                (a, MANY) => format!("at least {a} {}", plural(a)),
                (a, b) if a == b => format!("{a} {}", plural(a)),
                (a, b) => format!("{a} to {b} arguments"),
            };
            let span = program.tree.span(i as AstId);
            let message = format!("`{name}` takes {wanted}, not {count}");
            let error = Error::new(source, ErrorKind::Arguments, span, message);
            return Err(match signature(callee) {
                Some(usage) => error.with_help(format!("the form is `{usage}`")),
                None => error,
            });
        }
    }
    Ok(())
}

/// How to call a function whose arguments are not obvious.
fn signature(callee: Callee) -> Option<&'static str> {
    let Callee::Builtin(f) = callee else { return None };
    Some(match f {
        Builtin::Atan2 => "atan2(y, x)",
        Builtin::Difference => "difference(shape, removed, ...)",
        Builtin::SmoothUnion => "smooth_union(a, b, radius)",
        Builtin::SmoothIntersection => "smooth_intersection(a, b, radius)",
        Builtin::SmoothDifference => "smooth_difference(a, b, radius)",
        Builtin::Translate => "translate(shape, dx, dy, dz)",
        Builtin::Rotate => "rotate(shape, degrees_about_x, degrees_about_y, degrees_about_z)",
        Builtin::Scale => "scale(shape, factor)` or `scale(shape, fx, fy, fz)",
        Builtin::Torus => "torus(big_radius, small_radius)",
        Builtin::Box => "box(half_x, half_y, half_z)",
        Builtin::Cylinder => "cylinder(radius, half_height)",
        _ => return None,
    })
}

impl Lowering<'_> {
    fn run(&mut self, body: &Body) -> Result<NodeId, Error> {
        let mut frames = vec![Frame::new(body, vec![], self.program.tree.span(body.root))];
        loop {
            let depth = frames.len();
            let frame = &mut frames[depth - 1];
            if frame.next == frame.body.nodes.end {
                let value = frame.value(frame.body.root);
                frames.pop();
                match frames.last_mut() {
                    None => return Ok(value),
                    Some(caller) => caller.values.push(value),
                }
                continue;
            }
            self.steps += 1;
            self.check_size(&frame.span)?;
            let id = frame.next;
            frame.next += 1;
            let ast = self.program.tree.nodes[id as usize];
            if let Ast::Call { callee: Callee::User(d), first, count } = ast {
                let arguments = self.arguments(frame, first, count);
                let span = if depth == 1 { self.program.tree.span(id) } else { frame.span.clone() };
                frames.push(Frame::new(&self.program.definitions[d as usize].body, arguments, span));
                continue;
            }
            let value = self.value(frame, id, ast)?;
            if matches!(ast, Ast::Binary(..) | Ast::Call { .. }) {
                self.steps += self.graph.exact(value).map_or(0, exact::cost);
            }
            frame.values.push(value);
        }
    }

    fn check_size(&self, span: &Range<usize>) -> Result<(), Error> {
        if self.steps <= MAX_STEPS && self.graph.nodes().len() <= MAX_NODES {
            return Ok(());
        }
        Err(too_large(self.source, span.clone()))
    }

    fn arguments(&self, frame: &Frame, first: u32, count: u32) -> Vec<NodeId> {
        let ids = &self.program.tree.arguments[first as usize..(first + count) as usize];
        ids.iter().map(|&id| frame.value(id)).collect()
    }

    fn value(&mut self, frame: &Frame, id: AstId, ast: Ast) -> Result<NodeId, Error> {
        let g = &mut self.graph;
        Ok(match ast {
            Ast::Number(i) => {
                let q = self.program.tree.numbers[i as usize].clone();
                g.rational(q)
            }
            Ast::Name(symbol) => self.symbol(frame, symbol),
            Ast::Negate(a) => g.unary(Unary::Neg, frame.value(a)),
            Ast::Root(a) => g.unary(Unary::Sqrt, frame.value(a)),
            Ast::Binary(operation, a, b) => {
                let (left, right) = (frame.value(a), frame.value(b));
                let op = match operation {
                    Operation::Add => super::Binary::Add,
                    Operation::Subtract => super::Binary::Sub,
                    Operation::Multiply => super::Binary::Mul,
                    Operation::Divide => {
                        return meaning::divide(g, left, right)
                            .map_err(|meaning::ZeroDivisor| self.zero_divisor(self.program.tree.span(b)));
                    }
                    Operation::Power => return self.power(left, right, self.program.tree.span(b)),
                };
                g.binary(op, left, right)
            }
            Ast::Call { callee, first, count } => {
                let arguments = self.arguments(frame, first, count);
                let span = self.program.tree.span(id);
                match callee {
                    Callee::Builtin(f) => return self.call(f, &arguments, span),
                    Callee::User(_) => unreachable!("calls of definitions are frames"),
                }
            }
        })
    }

    fn symbol(&mut self, frame: &Frame, symbol: Symbol) -> NodeId {
        let g = &mut self.graph;
        match symbol {
            Symbol::Axis(axis) => g.axis(axis),
            Symbol::Pi => g.pi(),
            Symbol::E => g.e(),
            Symbol::Tau => {
                let (two, pi) = (g.integer(2), g.pi());
                g.binary(super::Binary::Mul, two, pi)
            }
            Symbol::Phi => {
                let (one, two, five) = (g.integer(1), g.integer(2), g.integer(5));
                let root = g.unary(Unary::Sqrt, five);
                let sum = g.binary(super::Binary::Add, one, root);
                g.binary(super::Binary::Div, sum, two)
            }
            Symbol::Parameter(i) => frame.arguments[i as usize],
            Symbol::User(i) => match self.constants[i as usize] {
                Some(value) => value,
                None => unreachable!("a definition names only earlier ones"),
            },
        }
    }

    fn zero_divisor(&self, span: Range<usize>) -> Error {
        Error::new(self.source, ErrorKind::DivisionByZero, span, "division by a constant that is exactly 0")
            .with_help("the formula would be defined nowhere")
    }

    /// An exponent that is an integer constant makes the integer power, defined for negative bases too; every other one makes
    /// the real power, defined for bases >= 0.
    fn power(&mut self, a: NodeId, b: NodeId, span: Range<usize>) -> Result<NodeId, Error> {
        let Some(q) = self.graph.exact(b).filter(|q| q.is_integer()) else {
            return Ok(self.graph.binary(super::Binary::Pow, a, b));
        };
        let Some(n) = exact::integer(q) else {
            let message = format!("an integer exponent beyond {}", i32::MAX);
            return Err(Error::new(self.source, ErrorKind::Exponent, span, message));
        };
        if n < 0 && self.graph.exact(a).is_some_and(Zero::is_zero) {
            return Err(self.zero_divisor(span));
        }
        if n == 1 {
            return Ok(a);
        }
        Ok(self.graph.powi(a, n))
    }

    fn call(&mut self, f: Builtin, a: &[NodeId], span: Range<usize>) -> Result<NodeId, Error> {
        match f {
            Builtin::Pow => self.power(a[0], a[1], span),
            Builtin::Translate | Builtin::Rotate | Builtin::Scale => {
                let by = meaning::transformed(&mut self.graph, f, &a[1..])
                    .map_err(|meaning::ZeroDivisor| self.zero_divisor(span.clone()))?;
                let (source, steps) = (self.source, &mut self.steps);
                let shape = meaning::substitute(&mut self.graph, a[0], by, |graph| {
                    *steps += 1;
                    if *steps <= MAX_STEPS && graph.nodes().len() <= MAX_NODES {
                        Ok(())
                    } else {
                        Err(too_large(source, span.clone()))
                    }
                })?;
                // One factor: lengths grow with the shape, so that a distance stays one.
                let uniform = f == Builtin::Scale && a.len() == 2;
                Ok(if uniform { self.graph.binary(super::Binary::Mul, a[1], shape) } else { shape })
            }
            _ => meaning::call(&mut self.graph, f, a).map_err(|meaning::ZeroDivisor| self.zero_divisor(span)),
        }
    }
}

fn too_large(source: &str, span: Range<usize>) -> Error {
    let message = format!("the formula expands to more than {MAX_NODES} operations, or takes too long to expand");
    Error::new(source, ErrorKind::TooLarge, span, message)
        .with_help("functions of functions multiply: write sums and products out, or use fewer nested transforms")
}
