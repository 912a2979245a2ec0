(** * How exported certificates are written

    Numbers and formulas of a certificate, in Coq files as in its text: [-174.75*sqrt(3)/2^2].
    `orthocert export rocq` writes them; with names as [Name "x"], and those of an atlas's
    parameters as [Name (Called "x")]. *)

From Coq Require Export ZArith Reals List String.
From Orthocert Require Export Claim.
From Orthocert.kernel Require Export Configuration Legs Written Turning TwinsDriven TwinsWritten Cubes Closed Statement Witness Certificate.
Export ListNotations.

Declare Scope written_scope.
Delimit Scope written_scope with written.
Bind Scope written_scope with term.

(** Digits, and decimals after a point; with a sign before them, [Negative]. *)
Inductive numeral := Unsigned (whole decimals : Decimal.uint) | Signed (whole decimals : Decimal.uint).
Definition negative {N : Type} (whole decimals : Decimal.uint) : term N := Negative (Literal whole decimals).
Definition numeral_of (x : Number.number) : option numeral :=
  match x with
  | Number.Decimal (Decimal.Decimal (Decimal.Pos w) d) => Some (Unsigned w d)
  | Number.Decimal (Decimal.Decimal (Decimal.Neg w) d) => Some (Signed w d)
  | Number.Decimal (Decimal.DecimalExp _ _ _) | Number.Hexadecimal _ => None
  end.
Definition digits_of (x : numeral) : option Number.number :=
  match x with
  | Unsigned w d => Some (Number.Decimal (Decimal.Decimal (Decimal.Pos w) d))
  | Signed w d => Some (Number.Decimal (Decimal.Decimal (Decimal.Neg w) d))
  end.
Number Notation term numeral_of digits_of (via numeral mapping [[Literal] => Unsigned, [negative] => Signed]) : written_scope.

Infix "+" := (Binary Addition) : written_scope.
Infix "-" := (Binary Subtraction) : written_scope.
Infix "*" := (Binary Multiplication) : written_scope.
Infix "/" := (Binary Division) : written_scope.
Notation "- x" := (Negative x) : written_scope.
Notation "x ^ n" := (Power x n%positive) : written_scope.
Notation sqrt := SquareRoot.
Arguments SquareRoot {N} x%written.
Arguments Name {N} n%string.

(** A quantity without a tolerance, also in vectors. *)
Definition single (x : term reference) : quantity := One x.
#[nonuniform] Coercion single : term >-> quantity.
Arguments Triple {A} &.
Arguments cons {A} &.
Arguments pair {A B} &.
Arguments Some {A} &.
