// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/spelling.h"

#include "grade/parts/latex_letters.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { MAX_NAME = 64, MAX_NESTING = 100 };

// ---- characters beyond ASCII ----

// clang-format off
static const struct {
    const char *utf8, *ascii;
} CHARACTERS[] = {
    {"\xef\xbb\xbf", ""},                                                        // byte-order mark
    {"−", "-"},     {"–", "-"},    {"—", "-"},   {"‐", "-"},      {"‑", "-"},    // dashes
    {"×", "*"},     {"·", "*"},    {"⋅", "*"},   {"∗", "*"},      {"•", "*"},    // products
    {"½", "(1/2)"}, {"⅓", "(1/3)"}, {"⅔", "(2/3)"}, {"¼", "(1/4)"}, {"¾", "(3/4)"}, // fractions
    {"⅙", "(1/6)"}, {"⅛", "(1/8)"},                                              //
    {"÷", "/"},     {"∕", "/"},    {"⁄", "/"},   {"√", "sqrt"},                  // quotients
    {"⁰", "^0"},    {"¹", "^1"},   {"²", "^2"},  {"³", "^3"},     {"⁴", "^4"},   // powers
    {"₀", "0"},     {"₁", "1"},    {"₂", "2"},   {"₃", "3"},      {"₄", "4"},    // indices
    {"₅", "5"},     {"₆", "6"},    {"₇", "7"},   {"₈", "8"},      {"₉", "9"},    //
    {"α", "alpha"}, {"β", "beta"}, {"γ", "gamma"}, {"δ", "delta"}, {"θ", "theta"}, // letters
    {"ϑ", "theta"}, {"λ", "lambda"}, {"μ", "mu"}, {"π", "pi"},     {"ρ", "rho"},   //
    {"φ", "phi"},   {"ϕ", "phi"},  {"ψ", "psi"}, {"ω", "omega"}, {"ℓ", "l"},     //
    {"\xcc\x87", "dot"},                                                         // a dot above
    {"\xc2\xa0", " "}, {"\xe2\x80\x89", " "}, {"\xe2\x80\xaf", " "}, {"\xe2\x80\x8b", ""}, // spaces
    {"（", "("},    {"）", ")"},                                                 // wide brackets
};
// clang-format on
enum { N_CHARACTERS = sizeof CHARACTERS / sizeof *CHARACTERS };

/// Returns whether a fraction would stand behind a digit: 2½ is a sum, not the product that 2(1/2)
/// is. It is left to the parser to refuse.
static bool is_mixed(const hn_strbuf *out, const char *ascii) {
    return ascii[0] == '(' && ascii[1] && out->n > 0 &&
           isdigit((unsigned char)out->text[out->n - 1]);
}

/// Copies the text with the characters of the table in ASCII; others stay.
static void to_ascii(hn_strbuf *out, const char *text) {
    while (*text) {
        int i = (unsigned char)*text < 0x80 ? N_CHARACTERS : 0;
        while (i < N_CHARACTERS &&
               strncmp(text, CHARACTERS[i].utf8, strlen(CHARACTERS[i].utf8)) != 0) {
            i++;
        }

        if (i < N_CHARACTERS && !is_mixed(out, CHARACTERS[i].ascii)) {
            hn_strbuf_add(out, CHARACTERS[i].ascii);
            text += strlen(CHARACTERS[i].utf8);
        } else {
            hn_strbuf_add_n(out, text++, 1);
        }
    }
}

// ---- names ----

/// Functions of the parser, and what others call them. Capital letters are ignored.
static const char *const FUNCTIONS[][2] = {
    {"sin", "sin"},     {"cos", "cos"},     {"tan", "tan"},       {"asin", "asin"},
    {"acos", "acos"},   {"atan", "atan"},   {"arcsin", "asin"},   {"arccos", "acos"},
    {"arctan", "atan"}, {"sinh", "sinh"},   {"cosh", "cosh"},     {"tanh", "tanh"},
    {"exp", "exp"},     {"log", "log"},     {"ln", "log"},        {"sqrt", "sqrt"},
    {"abs", "abs"},     {"atan2", "atan2"}, {"arctan2", "atan2"}, {"sign", "sign"},
};
enum { N_FUNCTIONS = sizeof FUNCTIONS / sizeof *FUNCTIONS };

static const char *find_function(const char *name) {
    for (int i = 0; i < N_FUNCTIONS; i++) {
        if (strcasecmp(name, FUNCTIONS[i][0]) == 0) {
            return FUNCTIONS[i][1];
        }
    }
    return NULL;
}

static bool is_one_of(const char *const *words, const char *word) {
    while (*words && strcmp(*words, word) != 0) {
        words++;
    }
    return *words != NULL;
}

/// Modules that a formula copied from a program names before its functions.
static const char *const MODULES[] = {"np",    "numpy", "math", "Math",  "sp",
                                      "sympy", "cmath", "jnp",  "torch", NULL};
/// Commands of LaTeX that say nothing about the value.
static const char *const SILENT[] = {"left",         "right",     "big",    "Big",  "bigl",
                                     "bigr",         "bigg",      "Bigg",   "quad", "qquad",
                                     "displaystyle", "textstyle", "limits", NULL};
/// Commands that set the word in braces behind them in another face: a name or a function.
static const char *const FACES[] = {"mathrm", "operatorname", "text", "mathbf", "mathit",
                                    "mathsf", "boldsymbol",   "bm",   NULL};
/// Commands that are a space, a thin one or one that is taken back.
static const char SPACES[] = " ,;:!>";
/// Letters of LaTeX that are written in two ways.
static const char *const LETTERS[][2] = {{"varphi", "phi"},
                                         {"vartheta", "theta"},
                                         {"varrho", "rho"},
                                         {"varepsilon", "epsilon"},
                                         {"ell", "l"}};
static const char *const ELL[] = {"ell", NULL};
static const char *const DOT[] = {"dot", NULL};
static const char *const PRODUCTS[] = {"cdot", "times", "ast", NULL};
/// Commands without an index: the digits behind them are operands of their own.
static const char *const INDEXLESS[] = {"frac", "dfrac", "tfrac", "pi", NULL};
static const char *const FRACTIONS[] = {"frac", "dfrac", "tfrac", NULL};

// ---- rewriting ----

/// Kinds of operands that stand side by side.
typedef enum operand { NOTHING, A_NAME, A_NUMBER, A_FUNCTION, A_BARE_ARGUMENT } operand;

typedef struct rewriter {
    const char *start, *at, *word; ///< word: where the operand that is read begins
    hn_strbuf *out;
    int latex;       ///< 1: a name before a bracket is a factor, no function
    operand operand; ///< what the output ends in; a bare argument: sin a, without brackets
    int below;       ///< 1: a / was written last, 2: that operand stands below a /
    int nesting;
    const char *fault_at, *fault; ///< the first place that cannot be read; NULL: none
    const char *bare, *bare_end;  ///< the first "sin a" with a sum behind it; NULL: none
} rewriter;

static void rewrite(rewriter *w, char stop);

static void refuse(rewriter *w, const char *at, const char *why) {
    if (!w->fault) {
        w->fault_at = at;
        w->fault = why;
    }
}

static void skip_spaces(rewriter *w) {
    while (*w->at == ' ' || *w->at == '\t' || *w->at == '\n' || *w->at == '\r') {
        hn_strbuf_add_n(w->out, w->at++, 1);
    }
}

/// Called before an operand is written. Factors side by side are multiplied; two numbers are not:
/// 1 000 is no product.
static void begin_operand(rewriter *w, operand next) {
    const char *before = hn_strbuf_text(w->out);
    const bool blank = w->out->n > 0 && before[w->out->n - 1] == ' ';
    const bool halves = w->below == 2 && w->operand == A_NUMBER && blank; // 1/2 m: half of m
    if (w->operand && !(w->operand == A_NUMBER && next == A_NUMBER)) {
        if (w->operand == A_BARE_ARGUMENT && next != A_FUNCTION) {
            refuse(w, w->word, "sin a b may be sin(a)*b or sin(a*b); write the brackets");
        } else if (w->below == 2 && !halves) {
            refuse(w, w->word, "a/b c may be (a/b)*c or a/(b*c); write the product with *");
        }
        hn_strbuf_add(w->out, "*");
        w->below = 0;
    }
    w->operand = NOTHING;
}

static void end_operand(rewriter *w, operand written) {
    w->operand = written;
    w->below = w->below ? 2 : 0;
}

/// Returns whether a name of LaTeX ends before this letter: in m_2l_1 two names stand side by side.
static bool ends_at_letter(const rewriter *w, const char *name, size_t n) {
    return w->latex && n > 0 && isdigit((unsigned char)name[n - 1]) && memchr(name, '_', n) &&
           isalpha((unsigned char)*w->at) && strncmp(w->at, "dot", 3) != 0;
}

/// A name with its index: theta_1, theta_{12}; the backslash has been read.
static void read_name(rewriter *w, char name[MAX_NAME]) {
    size_t n = 0;
    while ((isalnum((unsigned char)*w->at) || *w->at == '_') && n < MAX_NAME - 1 &&
           !ends_at_letter(w, name, n)) {
        name[n++] = *w->at++;
    }
    if (n > 0 && name[n - 1] == '_' && *w->at == '{') {
        for (w->at++; isalnum((unsigned char)*w->at) && n < MAX_NAME - 1;) {
            name[n++] = *w->at++;
        }
        w->at += *w->at == '}';
    }
    name[n] = 0;
}

static void write_number(rewriter *w) {
    begin_operand(w, A_NUMBER);
    while (isdigit((unsigned char)*w->at) || *w->at == '.') {
        hn_strbuf_add_n(w->out, w->at++, 1);
    }

    // 1e-3, but not the e of 2exp(x)
    const char *digits = w->at + 1 + (w->at[0] && (w->at[1] == '-' || w->at[1] == '+'));
    if ((*w->at == 'e' || *w->at == 'E') && isdigit((unsigned char)*digits)) {
        hn_strbuf_add_n(w->out, w->at, (size_t)(digits - w->at));
        for (w->at = digits; isdigit((unsigned char)*w->at);) {
            hn_strbuf_add_n(w->out, w->at++, 1);
        }
    }
    end_operand(w, A_NUMBER);
}

/// Writes what stands between this bracket and its partner, in round brackets.
static void write_group(rewriter *w) {
    const char close = *w->at == '(' ? ')' : *w->at == '[' ? ']' : '}';
    begin_operand(w, A_NAME);
    const int below = w->below;
    w->at++;
    hn_strbuf_add(w->out, "(");
    rewrite(w, close);
    if (*w->at == close) {
        w->at++;
        hn_strbuf_add(w->out, ")");
    }
    w->below = below;
    end_operand(w, A_NAME);
}

static void write_word(rewriter *w);

/// Numerator or denominator: a group, or as LaTeX reads it the one digit, letter or command that
/// follows, as in \frac12. The parser reports anything else.
static void write_fraction_part(rewriter *w) {
    skip_spaces(w);
    if (*w->at == '{') {
        write_group(w);
    } else if (*w->at == '\\') {
        write_word(w);
    } else if (isalnum((unsigned char)*w->at)) {
        hn_strbuf_add_n(w->out, w->at++, 1);
    }
}

/// \frac{a}{b} as ((a)/(b)).
static void write_fraction(rewriter *w) {
    begin_operand(w, A_NAME);
    const int below = w->below;
    w->below = 0;
    hn_strbuf_add(w->out, "(");
    for (int part = 0; part < 2; part++) {
        w->nesting++;
        write_fraction_part(w);
        w->nesting--;
        w->operand = NOTHING;
        w->below = 0;
        hn_strbuf_add(w->out, part == 0 ? "/" : ")");
    }
    w->below = below;
    end_operand(w, A_NAME);
}

/// The exponent of sin^2(x), which stands behind the argument in the parser's spelling.
static void read_exponent(rewriter *w, char exponent[MAX_NAME]) {
    exponent[0] = 0;
    if (*w->at != '^') {
        return;
    }
    const char *p = w->at + 1;
    const int braces = *p == '{';
    size_t n = 0;
    for (p += braces; isdigit((unsigned char)*p) && n < MAX_NAME - 1; p++) {
        exponent[n++] = *p;
    }
    exponent[n] = 0;
    if (n > 0 && (!braces || *p == '}')) {
        w->at = p + braces;
    } else {
        exponent[0] = 0;
    }
}

/// The argument of a function: a group, or the one name that follows. A number without brackets
/// (sin 2x) is left to the parser to refuse: its end would be a guess.
static void write_argument(rewriter *w) {
    if (*w->at == '(' || *w->at == '[' || *w->at == '{') {
        write_group(w);
    } else if (isalpha((unsigned char)*w->at) || *w->at == '\\') {
        hn_strbuf_add(w->out, "(");
        write_word(w);
        hn_strbuf_add(w->out, ")");
    }
}

static void write_function(rewriter *w, const char *function) {
    char exponent[MAX_NAME];
    const char *root = w->at;
    begin_operand(w, A_FUNCTION);
    const int below = w->below;
    hn_strbuf_add(w->out, function);
    read_exponent(w, exponent);
    if (w->latex && *root == '[' && strcmp(function, "sqrt") == 0) {
        refuse(w, root, "\\sqrt[n] is not read; write (...)^(1/n)");
    }

    // the argument, without the space and the \left that may stand before it
    w->below = 0;
    const char *ahead = w->at + strspn(w->at, " \t\r\n");
    w->at = *ahead == '(' || *ahead == '[' || *ahead == '{' || *ahead == '\\' ||
                    isalpha((unsigned char)*ahead)
                ? ahead
                : w->at;
    if (w->latex && strncmp(w->at, "\\left", 5) == 0 && !isalpha((unsigned char)w->at[5])) {
        w->at += 5;
    }
    const bool bare = *w->at == '\\' || isalpha((unsigned char)*w->at);
    w->nesting++; // sin sin sin ... nests without a bracket
    write_argument(w);
    w->nesting--;
    const char sum = w->at[strspn(w->at, " \t\r\n")];
    if (bare && !w->bare && (sum == '+' || sum == '-')) {
        w->bare = w->word;
        w->bare_end = w->at;
    }
    if (exponent[0]) { // it stood before the argument
        hn_strbuf_printf(w->out, "^%s", exponent);
    }
    w->below = below;
    w->operand = NOTHING;
    if (bare || w->at[-1] == ')' || w->at[-1] == ']' || w->at[-1] == '}') {
        end_operand(w, bare ? A_BARE_ARGUMENT : A_FUNCTION);
    }
}

/// \operatorname{sin} is \sin, \mathrm{l}_1 is l_1: reads the braces when one word stands in them.
static void read_face(rewriter *w, char name[MAX_NAME]) {
    rewriter ahead = *w;
    char word[MAX_NAME], index[MAX_NAME] = "";
    if (*ahead.at++ != '{') {
        return;
    }
    ahead.at += *ahead.at == '\\' && hn_latex_is_letter(ahead.at + 1);
    read_name(&ahead, word);
    if (!word[0] || *ahead.at != '}') {
        return;
    }
    w->at = ahead.at + 1;
    if (*w->at == '_') {
        read_name(w, index);
    }
    snprintf(name, MAX_NAME, "%.30s%.30s", word, index);
}

/// \dot\theta_1, \dot{\theta}_1: the name with "dot" before its index, as thetadot_1.
static void read_dot(rewriter *w, char name[MAX_NAME]) {
    char word[MAX_NAME], index[MAX_NAME] = "";
    skip_spaces(w);
    const int brace = *w->at == '{';
    w->at += brace;
    w->at += *w->at == '\\' && hn_latex_is_letter(w->at + 1);
    read_name(w, word);
    if (brace && *w->at == '}') {
        w->at++;
        if (*w->at == '_') {
            read_name(w, index);
        }
    }
    const size_t n = strcspn(word, "_0123456789");
    snprintf(name, MAX_NAME, "%.*sdot%.20s%.20s", (int)(n < 20 ? n : 20), word, word + n, index);
}

/// Puts the plain letter for \varphi, \ell_1 and their like.
static void plain_letter(char name[MAX_NAME]) {
    for (size_t i = 0; i < sizeof LETTERS / sizeof *LETTERS; i++) {
        const size_t n = strlen(LETTERS[i][0]), m = strlen(LETTERS[i][1]);
        if (strncmp(name, LETTERS[i][0], n) == 0 && !isalpha((unsigned char)name[n])) {
            memmove(name + m, name + n, strlen(name + n) + 1);
            memcpy(name, LETTERS[i][1], m);
            return;
        }
    }
}

/// Returns whether a command of LaTeX is one that is read here; `name` may have an index behind it.
static bool is_known(const char *name) {
    char lower[MAX_NAME];
    snprintf(lower, sizeof lower, "%.*s", (int)strcspn(name, "_0123456789"), name);
    return hn_latex_is_letter(name) || find_function(lower) || hn_latex_is_word(name, SILENT) ||
           hn_latex_is_word(name, FACES) || hn_latex_is_word(name, ELL) ||
           hn_latex_is_word(name, DOT) || hn_latex_is_word(name, PRODUCTS) ||
           hn_latex_is_word(name, FRACTIONS);
}

/// Reads a word: a name, or the name that a command of LaTeX stands for. Empty: it has no value.
static void read_word(rewriter *w, char name[MAX_NAME], bool *command) {
    const char *start = w->at;
    *command = *w->at == '\\';
    w->at += *command;
    name[0] = 0;
    if (*command && !isalpha((unsigned char)*w->at)) {
        if (!*w->at || !strchr(SPACES, *w->at)) {
            refuse(w, start, "this backslash begins no command of LaTeX that is read here");
        }
        w->at += *w->at != 0;
        return;
    }
    read_name(w, name);
    if (*command && hn_latex_is_word(name, INDEXLESS)) {
        name[strcspn(name, "_0123456789")] = 0;
        w->at = start + 1 + strlen(name);
    }
    if (*command && !is_known(name)) {
        refuse(w, start, "this command of LaTeX is not read here");
    }

    // the commands that stand for a name, and those without a value
    if (*command && is_one_of(FACES, name)) {
        read_face(w, name);
    } else if (*command && is_one_of(DOT, name)) {
        read_dot(w, name);
    } else if (*command) {
        plain_letter(name);
    }
    if (*command && (is_one_of(SILENT, name) || is_one_of(FACES, name))) {
        name[0] = 0;
    }
}

/// Returns whether the name before a bracket is a function that only the parser knows, as max(a,
/// b).
static bool calls(const rewriter *w) {
    return *w->at == '(' && !w->latex;
}

/// A name, a function, a module or a command of LaTeX.
static void write_word(rewriter *w) {
    char name[MAX_NAME];
    bool command;
    read_word(w, name, &command);
    if (!name[0] || (is_one_of(MODULES, name) && *w->at == '.' && w->at++)) {
        return;
    }

    const char *function = find_function(name);
    if (command && is_one_of(PRODUCTS, name)) {
        hn_strbuf_add(w->out, "*");
        w->operand = NOTHING;
        w->below = 0;
    } else if (command && is_one_of(FRACTIONS, name) && w->nesting < MAX_NESTING) {
        write_fraction(w);
    } else if (function && w->nesting < MAX_NESTING) {
        write_function(w, function);
    } else {
        begin_operand(w, A_NAME);
        hn_strbuf_add(w->out, strcasecmp(name, "pi") == 0 ? "pi" : name);
        if (!calls(w)) {
            end_operand(w, A_NAME);
        }
    }
}

static void write_operator(rewriter *w) {
    if (*w->at == '$') {
        w->at++;
        return;
    }
    const bool closes = *w->at == ')' || *w->at == ']' || *w->at == '}';
    w->operand = closes ? A_NAME : NOTHING;
    w->below = *w->at == '/';
    hn_strbuf_add_n(w->out, w->at++, 1);
}

/// Rewrites up to the bracket `stop`, or to the end of the text.
static void rewrite(rewriter *w, char stop) {
    w->nesting++;
    w->operand = NOTHING;
    w->below = 0;
    for (skip_spaces(w); *w->at && *w->at != stop; skip_spaces(w)) {
        w->word = w->at;
        const int opens = *w->at == '(' || *w->at == '[' || *w->at == '{';
        if (isdigit((unsigned char)*w->at) || *w->at == '.') {
            write_number(w);
        } else if (isalpha((unsigned char)*w->at) || *w->at == '_' || *w->at == '\\') {
            write_word(w);
        } else if (opens && w->nesting < MAX_NESTING) {
            write_group(w);
        } else {
            write_operator(w);
        }
    }
    w->nesting--;
}

/// The column of the k-th character in ASCII, counted in the characters that were typed.
static int column_of(const char *text, const char *ascii, const char *at) {
    hn_strbuf prefix;
    int column = 1;
    hn_strbuf_init(&prefix);
    for (const char *p = text; *p; column++) {
        const char *next = p + 1;
        while (((unsigned char)*next & 0xc0) == 0x80) {
            next++;
        }
        hn_strbuf_clear(&prefix);
        char one[8];
        snprintf(one, sizeof one, "%.*s", (int)(next - p < 7 ? next - p : 7), p);
        to_ascii(&prefix, one);
        if (ascii + prefix.n > at) {
            break;
        }
        ascii += prefix.n;
        p = next;
    }
    hn_strbuf_reset(&prefix);
    return column;
}

hn_status hn_spelling_normalise(hn_strbuf *out, const char *text, hn_diag *diag) {
    hn_strbuf ascii;
    hn_strbuf_init(&ascii);
    to_ascii(&ascii, text);
    rewriter w = {.at = hn_strbuf_text(&ascii), .out = out};
    w.start = w.at;
    w.latex = strchr(w.at, '\\') != NULL;
    rewrite(&w, 0);
    hn_status status = ascii.failed || out->failed ? HN_ERR_MEMORY : HN_OK;
    if (status == HN_OK && w.fault) {
        status = hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "column %d, at '%.12s': %s",
                             column_of(text, w.start, w.fault_at), w.fault_at, w.fault);
    }
    hn_strbuf_reset(&ascii);
    return status;
}

void hn_spelling_remark_bare(const char *formula, char *sentence, size_t size) {
    hn_strbuf ascii, plain;
    hn_strbuf_init(&ascii);
    hn_strbuf_init(&plain);
    to_ascii(&ascii, formula);
    rewriter w = {.at = hn_strbuf_text(&ascii), .out = &plain};
    w.start = w.at;
    w.latex = strchr(w.at, '\\') != NULL;
    rewrite(&w, 0);
    if (w.bare) {
        const size_t used = strlen(sentence);
        snprintf(sentence + used, size - used,
                 "; '%.*s' was read without the sum behind it: write brackets around its argument",
                 (int)(w.bare_end - w.bare), w.bare);
    }
    hn_strbuf_reset(&ascii);
    hn_strbuf_reset(&plain);
}

int hn_spelling_join(const char *name, char *out, size_t size) {
    size_t n = 0;
    for (const char *p = name; *p && n + 1 < size; p++) {
        if (*p != '_') {
            out[n++] = *p;
        }
    }
    out[n] = 0;
    return n > 0 && n < strlen(name) && strlen(name) < size;
}

/// theta1dot, th1_dot as thetadot1, thdot1: the dot before the index; other names as they are.
static void move_dot(const char *name, char out[MAX_NAME]) {
    size_t n = strlen(name), digits = 0;
    snprintf(out, MAX_NAME, "%s", name);
    if (n < 5 || n >= MAX_NAME || strcmp(name + n - 3, "dot") != 0) {
        return;
    }
    n -= 3;
    n -= name[n - 1] == '_';
    while (digits < n && isdigit((unsigned char)name[n - 1 - digits])) {
        digits++;
    }
    if (digits > 0 && digits < n) {
        snprintf(out, MAX_NAME, "%.*sdot%.*s", (int)(n - digits), name, (int)digits,
                 name + n - digits);
    }
}

int hn_spelling_alias(const char *name, int i, char *out, size_t size) {
    // an angular velocity is w1 or u1 here, and an angle th1; t alone is the time
    static const char *const aliases[][2] = {
        {"thetadot", "w"}, {"thetadot", "om"}, {"thetadot", "u"}, {"thdot", "w"},  {"thdot", "u"},
        {"dtheta", "w"},   {"dtheta", "u"},    {"dth", "w"},      {"dth", "u"},    {"qdot", "w"},
        {"qdot", "u"},     {"dq", "w"},        {"dq", "u"},       {"theta", "th"}, {"q", "th"},
        {"omega", "w"},    {"omega", "om"},    {"omega", "u"},    {"alpha", "al"}, {"beta", "be"},
        {"gamma", "ga"},   {"lambda", "la"},   {"w", "om"},       {"w", "u"},      {"t", "th"},
    };
    char plain[MAX_NAME];
    move_dot(name, plain);
    for (size_t k = 0; k < sizeof aliases / sizeof *aliases; k++) {
        const size_t n = strlen(aliases[k][0]);
        const bool ends = n == 1 && *plain == 't' ? isdigit((unsigned char)plain[n]) != 0
                                                  : !isalpha((unsigned char)plain[n]);
        if (ends && strncmp(plain, aliases[k][0], n) == 0 && i-- == 0) {
            return snprintf(out, size, "%s%s", aliases[k][1], plain + n) < (int)size;
        }
    }
    return 0;
}
