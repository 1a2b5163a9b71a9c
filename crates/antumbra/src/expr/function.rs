//! The built-in functions by name: spelling and number of arguments. Their meaning is in `meaning.rs`.

macro_rules! functions {
    ($($variant:ident $min:literal $max:literal $($name:literal)+;)*) => {
        /// A function of the language.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(crate) enum Builtin { $($variant,)* }

        impl Builtin {
            /// The function of that name.
            pub(crate) fn find(name: &str) -> Option<Self> {
                match name { $($($name)|+ => Some(Self::$variant),)* _ => None }
            }

            /// Every name, aliases included.
            pub(crate) const NAMES: &[&str] = &[$($($name,)+)*];

            /// Fewest and most arguments.
            pub(crate) const fn arity(self) -> (u32, u32) {
                match self { $(Self::$variant => ($min, $max),)* }
            }

            /// The first of its names.
            pub(crate) fn name(self) -> &'static str {
                match self { $(Self::$variant => [$($name),+][0],)* }
            }
        }
    };
}

/// More than any source can hold: "as many as you like".
pub(crate) const MANY: u32 = u32::MAX;

functions! {
    Sin 1 1 "sin";
    Cos 1 1 "cos";
    Tan 1 1 "tan";
    Sec 1 1 "sec";
    Csc 1 1 "csc";
    Cot 1 1 "cot";
    Asin 1 1 "asin" "arcsin";
    Acos 1 1 "acos" "arccos";
    Atan 1 1 "atan" "arctan";
    Atan2 2 2 "atan2" "arctan2";
    Sinh 1 1 "sinh";
    Cosh 1 1 "cosh";
    Tanh 1 1 "tanh";
    Exp 1 1 "exp";
    Ln 1 1 "ln" "log";
    Log10 1 1 "log10";
    Log2 1 1 "log2";
    Sqrt 1 1 "sqrt";
    Cbrt 1 1 "cbrt";
    Abs 1 1 "abs";
    Sign 1 1 "sign" "sgn";
    Floor 1 1 "floor";
    Ceil 1 1 "ceil";
    Min 1 4294967295 "min";
    Max 1 4294967295 "max";
    Mod 2 2 "mod";
    Pow 2 2 "pow";
    Powr 2 2 "powr";
    Union 1 4294967295 "union";
    Intersection 1 4294967295 "intersection";
    Difference 2 4294967295 "difference";
    SmoothUnion 3 3 "smooth_union";
    SmoothIntersection 3 3 "smooth_intersection";
    SmoothDifference 3 3 "smooth_difference";
    Translate 4 4 "translate";
    Rotate 4 4 "rotate";
    Scale 2 4 "scale";
    Sphere 1 1 "sphere";
    Torus 2 2 "torus";
    Box 1 3 "box";
    Cylinder 1 2 "cylinder";
}
