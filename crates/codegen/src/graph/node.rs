//! One operation of an expression graph.

/// An expression: the index of its node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Id(pub(crate) u32);

impl Id {
    /// Position of the node in its graph; operands come before what is made of them.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// An operation and its operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    /// A number, by its bits, so that nodes can be hashed.
    Constant(u64),
    /// An input of the function, counted through all its arguments.
    Input(u32),
    /// `−a`.
    Neg(Id),
    /// `a + b`, operands in ascending order.
    Add(Id, Id),
    /// `a − b`.
    Sub(Id, Id),
    /// `a b`, operands in ascending order.
    Mul(Id, Id),
    /// `a / b`.
    Div(Id, Id),
    /// An elementary function.
    Call(Elementary, Id),
    /// The angle of the point with ordinate `a` and abscissa `b`, in (−π, π].
    Atan2(Id, Id),
    /// `c` where `a < b`, else `d`.
    Select([Id; 4]),
}

/// An elementary function of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Elementary {
    /// Sine of an angle [rad].
    Sin,
    /// Cosine of an angle [rad].
    Cos,
    /// Square root.
    Sqrt,
    /// Hyperbolic tangent.
    Tanh,
    /// Natural exponential.
    Exp,
}

impl Elementary {
    /// Its value.
    pub fn of(self, x: f64) -> f64 {
        match self {
            Self::Sin => x.sin(),
            Self::Cos => x.cos(),
            Self::Sqrt => x.sqrt(),
            Self::Tanh => x.tanh(),
            Self::Exp => x.exp(),
        }
    }

    /// Its name in C, Rust and NumPy.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sin => "sin",
            Self::Cos => "cos",
            Self::Sqrt => "sqrt",
            Self::Tanh => "tanh",
            Self::Exp => "exp",
        }
    }
}

impl Node {
    /// The number, if it is one.
    pub fn as_constant(self) -> Option<f64> {
        match self {
            Self::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// Its operands in order, as many as it has.
    pub fn operands(self) -> impl DoubleEndedIterator<Item = Id> + Clone {
        let (ids, n) = match self {
            Self::Constant(_) | Self::Input(_) => ([Id(0); 4], 0),
            Self::Neg(a) | Self::Call(_, a) => ([a; 4], 1),
            Self::Add(a, b) | Self::Sub(a, b) | Self::Mul(a, b) | Self::Div(a, b) | Self::Atan2(a, b) => {
                ([a, b, b, b], 2)
            }
            Self::Select(all) => (all, 4),
        };
        ids.into_iter().take(n)
    }

    /// Whether it computes something: it is neither number nor input.
    pub fn is_operation(self) -> bool {
        !matches!(self, Self::Constant(_) | Self::Input(_))
    }
}
