//Provides: oc_add const
function oc_add(a, b) { return a + b; }
//Provides: oc_sub const
function oc_sub(a, b) { return a - b; }
//Provides: oc_mul const
function oc_mul(a, b) { return a * b; }
//Provides: oc_neg const
function oc_neg(a) { return -a; }
//Provides: oc_abs const
function oc_abs(a) { return a < 0 ? -a : a; }
//Provides: oc_eq const
function oc_eq(a, b) { return a == b ? 1 : 0; }
//Provides: oc_le const
function oc_le(a, b) { return a <= b ? 1 : 0; }
//Provides: oc_lt const
function oc_lt(a, b) { return a < b ? 1 : 0; }
//Provides: oc_compare const
function oc_compare(a, b) { return a < b ? -1 : a > b ? 1 : 0; }
//Provides: oc_sign const
function oc_sign(a) { return a < 0 ? -1 : a > 0 ? 1 : 0; }
//Provides: oc_of_int const
function oc_of_int(n) { return globalThis.BigInt(n); }
// A number of 32 bits, or an error: nothing is cut off.
//Provides: oc_to_int
function oc_to_int(a) {
  var n = globalThis.Number(a);
  if (n !== (n | 0)) throw new globalThis.Error("a number of more than 32 bits");
  return n;
}
// Numbers that shifts are by, made once.
//Provides: oc_small
var oc_small = [];
//Provides: oc_count const
//Requires: oc_small
function oc_count(n) { return oc_small[n] || (oc_small[n] = globalThis.BigInt(n)); }
//Provides: oc_emod const
//Requires: oc_abs
function oc_emod(a, b) { var r = a % b; return r < 0 ? r + oc_abs(b) : r; }
//Provides: oc_ediv const
//Requires: oc_emod
function oc_ediv(a, b) { return (a - oc_emod(a, b)) / b; }
//Provides: oc_shl const
//Requires: oc_count
function oc_shl(a, n) { return a << oc_count(n); }
// The floor, also of negative numbers.
//Provides: oc_shr const
//Requires: oc_count
function oc_shr(a, n) { return a >> oc_count(n); }
// The floor of the root: Newton's steps from a power of two above it decrease to it.
//Provides: oc_sqrt const
function oc_sqrt(a) {
  if (a < 0) throw new globalThis.Error("a root of a negative number");
  if (a < 2) return a;
  var one = globalThis.BigInt(1);
  var x = one << globalThis.BigInt((a.toString(16).length * 4 + 1) / 2 | 0), y;
  for (;;) {
    y = (x + a / x) >> one;
    if (y >= x) return x;
    x = y;
  }
}
// What pages call, with strings of bytes; and "node verified.js FILE..", which says what orthocert-verified says, with
// its exit codes.
//Provides: oc_export
//Requires: caml_call_gen, caml_string_of_jsbytes, caml_jsbytes_of_string
function oc_export(verify) {
  function answer(text) {
    return caml_jsbytes_of_string(caml_call_gen(verify, [caml_string_of_jsbytes(text)]));
  }
  globalThis.orthocert_verify = answer;
  if (typeof module !== "object" || typeof require !== "function" || require.main !== module) return;
  var node = globalThis.process, paths = node.argv.slice(2), worst = paths.length ? 0 : 2;
  if (!paths.length) node.stderr.write("usage: node verified.js CERT.json..\n");
  paths.forEach(function (path) {
    var said, code;
    try {
      said = answer(require("fs").readFileSync(path, "latin1"));
      code = { CERTIFIED: 0, REFUTED: 1, REJECTED: 5 }[said];
      node.stdout.write(said + "\n");
      if (code === undefined) code = 3;
    } catch (error) {
      node.stderr.write("error: " + error.message + "\n");
      code = 2;
    }
    worst = Math.max(worst, code);
  });
  node.exitCode = worst;
}
