// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/language.h"

#include "expr/print.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

/// Names that the texts with places use beside those of the scene.
#define OWN                                                                                       \
    " q v mass force jacobian bias closure closure_rate energy NQ NV NC START_Q START_V START_A " \
    "ENERGY "                                                                                     \
    "CHECK_T CHECK_Q CHECK_V CHECK_A ALPHA BETA METHOD METHOD_H METHOD_STEPS METHOD_GAP steps "   \
    "rates terms move slope close "
#define WOLFRAM_OWN                                                                          \
    "startQ startV startA startEnergy checkQ checkV checkA checkT rate nQ nV nC end motion " \
    "checks "
#define C_WORDS                                                                                  \
    " auto break case char const continue default do double else enum extern float for goto if " \
    "inline int long register restrict return short signed sizeof static struct switch typedef " \
    "union unsigned void volatile while class new delete this template try catch throw public "  \
    "private protected operator namespace using final byte boolean package import "

/// C, and languages whose functions have the same names.
#define C_CALLS                                                                          \
    [HN_OP_RECIP] = "1.0 / (#1)", [HN_OP_POW] = "pow(#1, #2)", [HN_OP_ABS] = "fabs(#1)", \
    [HN_OP_MIN] = "fmin(#1, #2)", [HN_OP_MAX] = "fmax(#1, #2)"

#define JAVA(name) "Math." #name "(#1)"

/// A name without '_', which makes a pattern in Wolfram's language.
static void put_wolfram_name(hn_strbuf *b, const char *name) {
    for (; *name; name++) {
        hn_strbuf_add_n(b, *name == '_' ? "$" : name, 1);
    }
}

/// Words without the end of a comment.
static void put_wolfram_words(hn_strbuf *b, const char *words) {
    for (; *words; words++) {
        hn_strbuf_add_n(b, words, 1);
        hn_strbuf_add(b, words[0] == '*' && words[1] == ')' ? " " : "");
    }
}

/// Words with TeX's special characters spelled as characters.
static void put_latex_words(hn_strbuf *b, const char *words) {
    for (; *words; words++) {
        if (strchr("\\^~", *words)) {
            hn_strbuf_printf(b, "\\char`\\%c{}", *words);
        } else {
            hn_strbuf_add(b, strchr("_%#&${}", *words) ? "\\" : "");
            hn_strbuf_add_n(b, words, 1);
        }
    }
}

/// A name whose index is upright where that is a word.
static void put_latex_name(hn_strbuf *b, const char *name) {
    hn_strbuf plain;
    hn_strbuf_init(&plain);
    hn_print_latex_name(&plain, name);
    const char *text = hn_strbuf_text(&plain);
    const char *index = strstr(text, "_{");
    if (index && isalpha((unsigned char)index[2]) && isalpha((unsigned char)index[3])) {
        const size_t n = strcspn(index + 2, "}");
        hn_strbuf_add_n(b, text, (size_t)(index + 2 - text));
        hn_strbuf_printf(b, "\\mathrm{%.*s}%s", (int)n, index + 2, index + 2 + n);
    } else {
        hn_strbuf_add(b, text);
    }
    b->failed |= plain.failed;
    hn_strbuf_reset(&plain);
}

/// A unit in upright letters with powers, m/s^2 as $\mathrm{m/s^{2}}$; other words as words.
static void put_latex_unit(hn_strbuf *b, const char *unit) {
    if (!isalpha((unsigned char)unit[0]) ||
        unit[strspn(unit, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789/*^ ")]) {
        put_latex_words(b, unit);
        return;
    }
    hn_strbuf_add(b, "\\ensuremath{\\mathrm{");
    while (*unit) {
        const size_t digits = *unit == '^' ? strspn(unit + 1, "0123456789") : 0;
        if (digits > 0) {
            hn_strbuf_printf(b, "^{%.*s}", (int)digits, unit + 1);
            unit += 1 + digits;
            continue;
        }
        if (*unit != '^') {
            hn_strbuf_printf(b, strchr("* ", *unit) ? "\\," : "%c", *unit);
        }
        unit++;
    }
    hn_strbuf_add(b, "}}");
}

static const hn_language_solver PYTHON_SOLVERS[] = {
    {"scipy", "an ordinary differential equation by scipy's DOP853"},
    {"petsc", "the differential-algebraic equations themselves by PETSc's BDF (petsc4py)"},
    {NULL, NULL}};
static const hn_language_solver CPP_SOLVERS[] = {
    {"own", "elimination written out: the standard library alone"},
    {"eigen", "Eigen's complete orthogonal decomposition"},
    {NULL, NULL}};
static const hn_language_solver JAVA_SOLVERS[] = {
    {"own", "elimination written out: Java's library alone"},
    {"ejml", "EJML's pseudo-inverse by singular values"},
    {NULL, NULL}};
static const hn_language_solver OCTAVE_SOLVERS[] = {
    {"ode45", "an ordinary differential equation by ode45"},
    {"ode15s", "the differential-algebraic equations themselves by ode15s"},
    {NULL, NULL}};

static const hn_language LANGUAGES[] = {
    {.name = "python",
     .suffix = ".py",
     .about = "Python with numpy and scipy",
     .has_steps = true,
     .comment = "#",
     .constant = "#1 = #2",
     .vector = "#1[#2] = #3",
     .matrix = "#1[#2, #3] = #4",
     .entry = "#1[#2]",
     .solvers = PYTHON_SOLVERS,
     .reserved =
         OWN "and as assert async await break class continue def del elif else except "
             "finally for from global if import in is lambda nonlocal not or pass raise "
             "return try while with yield np solve_ivp abs min max print range sys "
             "plot loop_gaps residual put_residual put_derivative independent_rows qr PETSc "
             "SimpleNamespace same_sign difference main sign step",
     .call = {[HN_OP_RECIP] = "1 / (#1)", [HN_OP_POW] = "(#1)**(#2)"}},
    {.name = "c",
     .suffix = ".c",
     .about = "C99, nothing but the C library",
     .has_steps = true,
     .comment = "//",
     .constant = "const double #1 = #2;",
     .vector = "#1[#2] = #3;",
     .matrix = "#1[#2][#3] = #4;",
     .entry = "#1[#2]",
     .needs_point = true,
     .reserved = OWN C_WORDS,
     .call = {C_CALLS}},
    {.name = "cpp",
     .suffix = ".cpp",
     .about = "C++17, nothing but the standard library",
     .has_steps = true,
     .comment = "//",
     .constant = "const double #1 = #2;",
     .vector = "#1[#2] = #3;",
     .matrix = "#1[#2][#3] = #4;",
     .entry = "#1[#2]",
     .needs_point = true,
     .solvers = CPP_SOLVERS,
     .reserved = OWN C_WORDS,
     .call = {C_CALLS}},
    {.name = "java",
     .suffix = ".java",
     .about = "Java, nothing but its library",
     .comment = "//",
     .constant = "final double #1 = #2;",
     .vector = "#1[#2] = #3;",
     .matrix = "#1[#2][#3] = #4;",
     .entry = "#1[#2]",
     .needs_point = true,
     .solvers = JAVA_SOLVERS,
     .reserved = OWN C_WORDS,
     .call = {[HN_OP_RECIP] = "1.0 / (#1)",     [HN_OP_POW] = "Math.pow(#1, #2)",
              [HN_OP_SQRT] = JAVA(sqrt),        [HN_OP_SIN] = JAVA(sin),
              [HN_OP_COS] = JAVA(cos),          [HN_OP_TAN] = JAVA(tan),
              [HN_OP_ASIN] = JAVA(asin),        [HN_OP_ACOS] = JAVA(acos),
              [HN_OP_ATAN] = JAVA(atan),        [HN_OP_ATAN2] = "Math.atan2(#1, #2)",
              [HN_OP_SINH] = JAVA(sinh),        [HN_OP_COSH] = JAVA(cosh),
              [HN_OP_TANH] = JAVA(tanh),        [HN_OP_EXP] = JAVA(exp),
              [HN_OP_LOG] = JAVA(log),          [HN_OP_ABS] = JAVA(abs),
              [HN_OP_SIGN] = JAVA(signum),      [HN_OP_STEP] = "((#1) >= 0 ? 1.0 : 0.0)",
              [HN_OP_MIN] = "Math.min(#1, #2)", [HN_OP_MAX] = "Math.max(#1, #2)"}},
    {.name = "octave",
     .suffix = ".m",
     .about = "GNU Octave or MATLAB, with ode45",
     .has_steps = true,
     .comment = "%",
     .constant = "#1 = #2;",
     .vector = "#1(#2) = #3;",
     .matrix = "#1(#2, #3) = #4;",
     .entry = "#1(#2)",
     .first = 1,
     .solvers = OCTAVE_SOLVERS,
     .reserved = OWN "break case catch continue do else elseif end endfor endfunction endif "
                     "endwhile for function global if otherwise persistent return switch try "
                     "until while unwind_protect abs min max e i j pi Inf NaN",
     .call = {[HN_OP_RECIP] = "1 / (#1)",
              [HN_OP_POW] = "(#1)^(#2)",
              [HN_OP_STEP] = "double((#1) >= 0)"}},
    {.name = "julia",
     .suffix = ".jl",
     .about = "Julia, nothing but its standard library",
     .comment = "#",
     .constant = "#1 = #2",
     .vector = "#1[#2] = #3",
     .matrix = "#1[#2, #3] = #4",
     .entry = "#1[#2]",
     .first = 1,
     .reserved = OWN "abstract begin break catch const continue do else elseif end export false "
                     "finally for function global if import let local macro module quote return "
                     "struct true try type using while abs min max pi im",
     .call = {[HN_OP_RECIP] = "1 / (#1)",
              [HN_OP_POW] = "(#1)^(#2)",
              [HN_OP_ATAN2] = "atan(#1, #2)",
              [HN_OP_STEP] = "Float64((#1) >= 0)"}},
    {.name = "wolfram",
     .suffix = ".wl",
     .about = "Wolfram Language, with NDSolve",
     .comment = "(*",
     .comment_end = " *)",
     .constant = "#1 = #2;",
     .vector = "#1[[#2]] = #3;",
     .matrix = "#1[[#2, #3]] = #4;",
     .entry = "#1[[#2]]",
     .first = 1,
     .power = "#1*^#2",
     .reserved =
         OWN WOLFRAM_OWN "alpha beta y time difference sameSign stiff soft drift matrix right "
                         "scale solution accelerations C D E I K N O",
     .put_name = put_wolfram_name,
     .put_array = put_wolfram_name,
     .put_words = put_wolfram_words,
     .call = {[HN_OP_RECIP] = "1/(#1)",    [HN_OP_POW] = "(#1)^(#2)",
              [HN_OP_SQRT] = "Sqrt[#1]",   [HN_OP_SIN] = "Sin[#1]",
              [HN_OP_COS] = "Cos[#1]",     [HN_OP_TAN] = "Tan[#1]",
              [HN_OP_ASIN] = "ArcSin[#1]", [HN_OP_ACOS] = "ArcCos[#1]",
              [HN_OP_ATAN] = "ArcTan[#1]", [HN_OP_ATAN2] = "ArcTan[#2, #1]",
              [HN_OP_SINH] = "Sinh[#1]",   [HN_OP_COSH] = "Cosh[#1]",
              [HN_OP_TANH] = "Tanh[#1]",   [HN_OP_EXP] = "Exp[#1]",
              [HN_OP_LOG] = "Log[#1]",     [HN_OP_ABS] = "Abs[#1]",
              [HN_OP_SIGN] = "Sign[#1]",   [HN_OP_STEP] = "UnitStep[#1]",
              [HN_OP_MIN] = "Min[#1, #2]", [HN_OP_MAX] = "Max[#1, #2]"}},
    {.name = "modelica",
     .suffix = ".mo",
     .about = "Modelica with its standard library",
     .comment = "//",
     .constant = "#1 := #2;",
     .vector = "#1[#2] := #3;",
     .matrix = "#1[#2, #3] := #4;",
     .entry = "#1[#2]",
     .first = 1,
     .reserved = OWN "algorithm and annotation assert block break class connect connector constant "
                     "constrainedby der discrete each else elseif elsewhen encapsulated end "
                     "enumeration equation expandable extends external false final flow for "
                     "function if import impure in initial inner input loop model not operator or "
                     "outer output package parameter partial protected public pure record "
                     "redeclare replaceable return stream then true type when while within time "
                     "abs min max sum Real Integer Boolean String",
     .call = {[HN_OP_RECIP] = "1/(#1)",
              [HN_OP_POW] = "(#1)^(#2)",
              [HN_OP_STEP] = "(if (#1) >= 0 then 1.0 else 0.0)"}},
    {.name = "latex",
     .suffix = ".tex",
     .about = "LaTeX: the equations to read, with every term",
     .comment = "\\remark{",
     .comment_end = "}",
     .constant = "\\eq{#1}{#2}",
     .vector = "\\eq{\\term{#1}_{#2}}{#3}",
     .matrix = "\\eq{\\term{#1}_{#2,#3}}{#4}",
     .entry = "#1_{#2}",
     .first = 1,
     .times = "\\, ",
     .power = "\\ensuremath{#1\\cdot 10^{#2}}",
     .fraction = "\\tfrac{#1}{#2}",
     .raised = "^{#1}",
     .given = "\\ensuremath{#1}",
     .named = "\\eq{#1}{#2}",
     .pieces = {"\\pieces{Pieces of parameters alone}", "\\pieces{Pieces of coordinates}",
                "\\pieces{Pieces of velocities}"},
     .depends = " \\remark{of $#1$}",
     .numbers = "\\pieces{Numbers}",
     .reserved = "",
     .put_name = put_latex_name,
     .put_words = put_latex_words,
     .put_unit = put_latex_unit,
     .call = {[HN_OP_RECIP] = "\\frac{1}{#1}",
              [HN_OP_POW] = "(#1)^{#2}",
              [HN_OP_SQRT] = "\\sqrt{#1}",
              [HN_OP_SIN] = "\\sin(#1)",
              [HN_OP_COS] = "\\cos(#1)",
              [HN_OP_TAN] = "\\tan(#1)",
              [HN_OP_ASIN] = "\\arcsin(#1)",
              [HN_OP_ACOS] = "\\arccos(#1)",
              [HN_OP_ATAN] = "\\arctan(#1)",
              [HN_OP_ATAN2] = "\\operatorname{atan2}(#1, #2)",
              [HN_OP_SINH] = "\\sinh(#1)",
              [HN_OP_COSH] = "\\cosh(#1)",
              [HN_OP_TANH] = "\\tanh(#1)",
              [HN_OP_EXP] = "\\exp(#1)",
              [HN_OP_LOG] = "\\ln(#1)",
              [HN_OP_ABS] = "\\lvert #1\\rvert",
              [HN_OP_SIGN] = "\\operatorname{sign}(#1)",
              [HN_OP_STEP] = "\\operatorname{step}(#1)",
              [HN_OP_MIN] = "\\min(#1, #2)",
              [HN_OP_MAX] = "\\max(#1, #2)"}},
};
enum { N_LANGUAGES = sizeof LANGUAGES / sizeof LANGUAGES[0] };

const hn_language *hn_languages(int *n) {
    *n = N_LANGUAGES;
    return LANGUAGES;
}

const hn_language *hn_language_find(const char *name) {
    for (int i = 0; i < N_LANGUAGES; i++) {
        if (strcmp(LANGUAGES[i].name, name) == 0) {
            return &LANGUAGES[i];
        }
    }
    return NULL;
}
