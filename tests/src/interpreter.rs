//! Generated code, interpreted: the tokens that `robot!` would hand to the
//! compiler, run without one, so that thousands of robots can be tried.
//!
//! It knows what generated code consists of and panics at everything else, as
//! the compiler would at a name that is bound twice or not at all.

use std::collections::HashMap;

use syn::{BinOp, Block, Expr, ExprIndex, ExprLit, File, ImplItem, Item, Lit, Member, Pat, Stmt, UnOp};

/// The generated code of one robot.
pub struct Code {
    constants: HashMap<String, f64>,
    methods: HashMap<String, Block>,
}

impl Code {
    /// The code among the items that were generated.
    pub fn of(file: File) -> Self {
        let mut code = Self { constants: HashMap::new(), methods: HashMap::new() };
        file.items.into_iter().for_each(|item| code.item(item));
        code
    }

    fn item(&mut self, item: Item) {
        match item {
            Item::Impl(item) => item.items.into_iter().for_each(|item| self.member(item)),
            Item::Const(item) => {
                let Expr::Block(hidden) = *item.expr else { panic!("a constant that hides its items") };
                for statement in hidden.block.stmts {
                    let Stmt::Item(item) = statement else { panic!("an item") };
                    self.item(item);
                }
            }
            Item::Struct(_) | Item::Use(_) => {}
            _ => panic!("an item that the generator writes"),
        }
    }

    fn member(&mut self, item: ImplItem) {
        match item {
            // What a call costs is no number of the calculation.
            ImplItem::Const(item) if matches!(item.expr, Expr::Struct(_)) => {}
            ImplItem::Const(item) => {
                let value = Scope {
                    code: self,
                    bound: HashMap::new(),
                    columns: HashMap::new(),
                    q: &[],
                    wrench: &[],
                    plays: Vec::new(),
                }
                .value(&item.expr);
                assert!(self.constants.insert(item.ident.to_string(), value).is_none(), "{} twice", item.ident);
            }
            ImplItem::Fn(item) => {
                self.methods.insert(item.sig.ident.to_string(), item.block);
            }
            _ => panic!("generated code has constants and methods"),
        }
    }

    /// The entries of what a method returns, in the order in which it builds
    /// them.
    ///
    /// # Panics
    /// Where the code is none that the generator writes.
    pub fn call(&self, method: &str, q: &[f64], wrench: &[f64]) -> Vec<f64> {
        self.call_with(method, q, wrench, &mut [])
    }

    /// The same with the play operators of each joint, which the method may
    /// bring up to date.
    ///
    /// # Panics
    /// Where the code is none that the generator writes.
    pub fn call_with(&self, method: &str, q: &[f64], wrench: &[f64], plays: &mut [[f64; 3]]) -> Vec<f64> {
        let block = &self.methods[method];
        match formulations(block) {
            Some((_, plain)) => self.run(plain, q, wrench, plays),
            None => self.run(block, q, wrench, plays),
        }
    }

    /// The same as scalars calculate that compute with columns as with one
    /// number, if the method has a formulation for them; frames by columns.
    ///
    /// # Panics
    /// Where the code is none that the generator writes.
    pub fn call_in_columns(&self, method: &str, q: &[f64]) -> Option<Vec<f64>> {
        let (in_columns, _) = formulations(&self.methods[method])?;
        Some(self.run(in_columns, q, &[], &mut []))
    }

    fn run(&self, block: &Block, q: &[f64], wrench: &[f64], plays: &mut [[f64; 3]]) -> Vec<f64> {
        let mut scope =
            Scope { code: self, bound: HashMap::new(), columns: HashMap::new(), q, wrench, plays: plays.to_vec() };
        let mut result = Vec::new();
        for statement in &block.stmts {
            match statement {
                Stmt::Local(local) => {
                    let value = &local.init.as_ref().expect("a value").expr;
                    let values = scope.entries(value);
                    if let (Pat::Ident(name), &[x, y, z, w]) = (&local.pat, values.as_slice()) {
                        let name = name.ident.to_string();
                        assert!(scope.columns.insert(name.clone(), [x, y, z, w]).is_none(), "{name} is bound twice");
                        continue;
                    }
                    assert_eq!(scope.bind(&local.pat, &values), values.len(), "as many names as values");
                }
                Stmt::Expr(Expr::Assign(assignment), Some(_)) => {
                    let (joint, index) = play(&assignment.left).expect("a play operator");
                    plays[joint][index] = scope.value(&assignment.right);
                }
                Stmt::Expr(expression, None) => result = scope.entries(expression),
                _ => panic!("a statement that is no let"),
            }
        }
        result
    }
}

/// A method's block in columns and its block in single numbers, if it has both.
fn formulations(block: &Block) -> Option<(&Block, &Block)> {
    let [Stmt::Expr(Expr::If(choice), None)] = block.stmts.as_slice() else { return None };
    assert_eq!(path(&choice.cond), "T::COLUMNS");
    let (_, Expr::Block(plain)) = choice.else_branch.as_ref().map(|(token, block)| (token, &**block))? else {
        panic!("both formulations")
    };
    Some((&choice.then_branch, &plain.block))
}

struct Scope<'c> {
    code: &'c Code,
    bound: HashMap<String, f64>,
    columns: HashMap<String, [f64; 4]>,
    q: &'c [f64],
    wrench: &'c [f64],
    plays: Vec<[f64; 3]>,
}

impl Scope<'_> {
    /// Binds names in order; returns how many values that took.
    fn bind(&mut self, pattern: &Pat, values: &[f64]) -> usize {
        let inner = match pattern {
            Pat::Ident(name) => {
                let name = name.ident.to_string();
                assert!(self.bound.insert(name.clone(), values[0]).is_none(), "{name} is bound twice");
                return 1;
            }
            Pat::Wild(_) => return 1,
            Pat::Slice(slice) => &slice.elems,
            Pat::Tuple(tuple) => &tuple.elems,
            _ => panic!("a pattern of names"),
        };
        inner.iter().fold(0, |taken, pattern| taken + self.bind(pattern, &values[taken..]))
    }

    /// The sines and cosines of the angles that a closure adds up.
    fn sines_and_cosines(&self, angles: &Expr) -> Vec<f64> {
        let Expr::Closure(angles) = angles else { panic!("a closure adds the angles up") };
        self.entries(&angles.body).into_iter().flat_map(|angle| [angle.sin(), angle.cos()]).collect()
    }

    /// The numbers in a matrix, a list, or a single one.
    fn entries(&self, expression: &Expr) -> Vec<f64> {
        match expression {
            Expr::Tuple(tuple) => tuple.elems.iter().flat_map(|entry| self.entries(entry)).collect(),
            Expr::Array(array) => array.elems.iter().flat_map(|entry| self.entries(entry)).collect(),
            Expr::Struct(fields) => fields.fields.iter().flat_map(|field| self.entries(&field.expr)).collect(),
            Expr::Call(call) => {
                let arguments = || call.args.iter().flat_map(|argument| self.entries(argument));
                match path(&call.func).as_str() {
                    "T::sin_cos_of_sums" => self.sines_and_cosines(&call.args[1]),
                    "T::scaled_sin_cos_of_sums" => {
                        let (plain, factors) = (self.sines_and_cosines(&call.args[1]), self.entries(&call.args[2]));
                        plain.into_iter().zip(factors).map(|(plain, factor)| plain * factor).collect()
                    }
                    "T::scaled" => {
                        let numbers: Vec<f64> = arguments().collect();
                        numbers[..4].iter().map(|entry| entry * numbers[4]).collect()
                    }
                    "T::plus_scaled" => {
                        let numbers: Vec<f64> = arguments().collect();
                        (0..4).map(|k| numbers[k] + numbers[4 + k] * numbers[8]).collect()
                    }
                    "T::product" => {
                        let numbers: Vec<f64> = arguments().collect();
                        (0..4).map(|k| numbers[k] * numbers[4 + k]).collect()
                    }
                    "T::plus_product" => {
                        let numbers: Vec<f64> = arguments().collect();
                        (0..4).map(|k| numbers[k] + numbers[4 + k] * numbers[8 + k]).collect()
                    }
                    "T::cycled" => {
                        let numbers: Vec<f64> = arguments().collect();
                        [1, 2, 0, 3].map(|k| numbers[k]).to_vec()
                    }
                    "T::direction" => arguments().take(3).chain([0.0]).collect(),
                    "T::turn_blocks" => turn_blocks(&arguments().collect::<Vec<_>>()),
                    "T::zero" => vec![0.0],
                    "T::one" => vec![1.0],
                    "T::of" | "Matrix4::new" | "Matrix6::new" | "Vector6::new" | "core::convert::From::from" => {
                        arguments().collect()
                    }
                    "core::primitive::f64::from_bits" => {
                        let Expr::Lit(ExprLit { lit: Lit::Int(bits), .. }) = &call.args[0] else { panic!("bits") };
                        vec![f64::from_bits(bits.base10_parse().expect("bits"))]
                    }
                    other => panic!("a call of {other}"),
                }
            }
            Expr::Path(_) if self.columns.contains_key(&path(expression)) => self.columns[&path(expression)].to_vec(),
            Expr::Index(index) if !is_column_entry(index) && !is_q(&index.expr) && play(expression).is_none() => {
                self.wrench.to_vec()
            }
            _ => vec![self.value(expression)],
        }
    }

    fn value(&self, expression: &Expr) -> f64 {
        match expression {
            Expr::Lit(literal) => match &literal.lit {
                Lit::Float(number) => number.base10_parse().expect("a number"),
                _ => panic!("a number that is no float"),
            },
            Expr::Paren(inner) => self.value(&inner.expr),
            Expr::Const(block) => match block.block.stmts.as_slice() {
                [Stmt::Expr(inner, None)] => self.value(inner),
                _ => panic!("a constant"),
            },
            Expr::Unary(unary) if matches!(unary.op, UnOp::Neg(_)) => -self.value(&unary.expr),
            Expr::Binary(binary) => {
                let (a, b) = (self.value(&binary.left), self.value(&binary.right));
                match binary.op {
                    BinOp::Add(_) => a + b,
                    BinOp::Sub(_) => a - b,
                    BinOp::Mul(_) => a * b,
                    BinOp::Div(_) => a / b,
                    _ => panic!("an operation of arithmetic"),
                }
            }
            Expr::Path(_) => {
                let name = path(expression);
                match name.strip_prefix("Self::") {
                    Some(constant) => self.code.constants[constant],
                    None => *self.bound.get(&name).unwrap_or_else(|| panic!("{name} is not bound")),
                }
            }
            Expr::Index(index) if is_q(&index.expr) => match &*index.index {
                Expr::Lit(literal) => match &literal.lit {
                    Lit::Int(joint) => self.q[joint.base10_parse::<usize>().expect("an index")],
                    _ => panic!("an index"),
                },
                _ => panic!("an index"),
            },
            Expr::Index(index) if is_column_entry(index) => {
                let Expr::Lit(ExprLit { lit: Lit::Int(entry), .. }) = &*index.index else { panic!("an index") };
                self.columns[&path(&index.expr)][entry.base10_parse::<usize>().expect("an index")]
            }
            Expr::Index(_) => {
                let (joint, index) = play(expression).expect("a play operator");
                self.plays[joint][index]
            }
            Expr::MethodCall(call) => {
                let value = self.value(&call.receiver);
                match call.method.to_string().as_str() {
                    // As on a target without the instruction: rounded twice.
                    "mul_add" => value * self.value(&call.args[0]) + self.value(&call.args[1]),
                    "sqrt" => value.sqrt(),
                    "recip" => value.recip(),
                    "max" => value.max(self.value(&call.args[0])),
                    "min" => value.min(self.value(&call.args[0])),
                    other => panic!("a call of {other}"),
                }
            }
            Expr::Call(_) => self.entries(expression)[0],
            _ => panic!("an expression of arithmetic"),
        }
    }
}

fn path(expression: &Expr) -> String {
    let Expr::Path(path) = expression else { panic!("a path") };
    path.path.segments.iter().map(|segment| segment.ident.to_string()).collect::<Vec<_>>().join("::")
}

fn is_q(expression: &Expr) -> bool {
    matches!(expression, Expr::Path(_)) && path(expression) == "q"
}

/// Whether it is `x1[2]`, neither `q[1]` nor a field's.
fn is_column_entry(index: &ExprIndex) -> bool {
    matches!(&*index.expr, Expr::Path(_)) && !is_q(&index.expr)
}

/// The joint and the number of `state.plays[1][0]`, from 0.
fn play(expression: &Expr) -> Option<(usize, usize)> {
    let index = |expression: &Expr| match expression {
        Expr::Lit(literal) => match &literal.lit {
            Lit::Int(index) => index.base10_parse().ok(),
            _ => None,
        },
        _ => None,
    };
    let Expr::Index(outer) = expression else { return None };
    let Expr::Index(inner) = &*outer.expr else { return None };
    let Expr::Field(field) = &*inner.expr else { return None };
    let is_plays = matches!(&field.member, Member::Named(name) if name == "plays") && path(&field.base) == "state";
    is_plays.then(|| Some((index(&inner.index)?, index(&outer.index)?)))?
}

/// `R M R^T` about z, as `Real::turn_blocks` states it, for four blocks, the last two of which are each
/// other's transposes: rows xx, xy, yy, xz, yz of one entry a block, then sine
/// and cosine.
fn turn_blocks(numbers: &[f64]) -> Vec<f64> {
    let [s, c] = [numbers[20], numbers[21]];
    let mut turned = vec![0.0; 20];
    for (block, transposed) in [0, 1, 3, 2].into_iter().enumerate() {
        let [xx, xy, yy, xz, yz] = [0, 1, 2, 3, 4].map(|row| numbers[4 * row + block]);
        let yx = numbers[4 + transposed];
        let t = s * (xx - yy) + c * (xy + yx);
        let entries = [xx - s * t, c * t - yx, yy + s * t, c * xz - s * yz, s * xz + c * yz];
        for (row, entry) in entries.into_iter().enumerate() {
            turned[4 * row + block] = entry;
        }
    }
    turned
}
