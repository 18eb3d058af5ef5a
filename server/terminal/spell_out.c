// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal/spell_out.h"

#include <ctype.h>
#include <string.h>

/// Kind of a character: a name keeps apart from its neighbours, an accent joins the
/// letter before it, digits of one script follow one sign.
typedef enum kind { SIGN, NAME, ACCENT, RAISED, LOWERED } kind;

// clang-format off
static const struct {
    const char *utf8, *ascii;
    kind kind;
} SPELLINGS[] = {
    {"α", "alpha", NAME}, {"β", "beta", NAME}, {"γ", "gamma", NAME}, {"δ", "delta", NAME},
    {"ε", "eps", NAME}, {"η", "eta", NAME}, {"θ", "theta", NAME}, {"κ", "kappa", NAME},
    {"λ", "lambda", NAME}, {"μ", "mu", NAME}, {"ν", "nu", NAME}, {"ξ", "xi", NAME},
    {"π", "pi", NAME}, {"ρ", "rho", NAME}, {"σ", "sigma", NAME}, {"τ", "tau", NAME},
    {"φ", "phi", NAME}, {"ψ", "psi", NAME}, {"ω", "omega", NAME}, {"Γ", "Gamma", NAME},
    {"Δ", "Delta", NAME}, {"Λ", "Lambda", NAME}, {"Φ", "Phi", NAME}, {"Ψ", "Psi", NAME},
    {"Ω", "Omega", NAME}, {"Σ", "sum", NAME}, {"Θ", "Theta", NAME}, {"ℓ", "l", NAME},
    {"∂", "d", NAME}, {"ℝ", "R", NAME}, {"∞", "inf", NAME}, {"√", "sqrt", NAME},
    {"∇", "grad", NAME}, {"∫", "int", NAME}, {"∈", "in", NAME}, {"∀", "all", NAME},
    {"°", "deg", NAME}, {"½", "1/2", NAME}, {"⅓", "1/3", NAME}, {"⅔", "2/3", NAME},
    {"¼", "1/4", NAME},
    {"\u0307", "dot", ACCENT}, {"\u0308", "ddot", ACCENT}, {"\u0302", "hat", ACCENT},
    {"\u0304", "bar", ACCENT}, {"\u0303", "tilde", ACCENT}, {"\u20d7", "vec", ACCENT},
    {"⁻", "-", RAISED}, {"⁰", "0", RAISED}, {"¹", "1", RAISED}, {"²", "2", RAISED},
    {"³", "3", RAISED}, {"⁴", "4", RAISED}, {"⁵", "5", RAISED}, {"⁶", "6", RAISED},
    {"⁷", "7", RAISED}, {"⁸", "8", RAISED}, {"⁹", "9", RAISED},
    {"₋", "-", LOWERED}, {"₀", "0", LOWERED}, {"₁", "1", LOWERED}, {"₂", "2", LOWERED},
    {"₃", "3", LOWERED}, {"₄", "4", LOWERED}, {"₅", "5", LOWERED}, {"₆", "6", LOWERED},
    {"₇", "7", LOWERED}, {"₈", "8", LOWERED}, {"₉", "9", LOWERED},
    {"ᵀ", "'", SIGN}, {"≤", "<=", SIGN}, {"≥", ">=", SIGN}, {"≠", "!=", SIGN},
    {"≈", "~", SIGN}, {"→", "->", SIGN}, {"↦", "->", SIGN}, {"±", "+-", SIGN},
    {"∓", "-+", SIGN}, {"⇒", "=>", SIGN}, {"⇔", "<=>", SIGN}, {"…", "...", SIGN},
    {"‖", "||", SIGN}, {"∝", "~", SIGN}, {"≪", "<<", SIGN}, {"≫", ">>", SIGN},
    {"⟨", "<", SIGN}, {"⟩", ">", SIGN}, {"≡", "==", SIGN}, {"⊗", "(x)", SIGN},
    {"·", "*", SIGN}, {"×", "x", SIGN}, {"−", "-", SIGN},
};
// clang-format on
enum { N_SPELLINGS = sizeof SPELLINGS / sizeof *SPELLINGS };

/// The text so far, and what its last character was.
typedef struct speller {
    hn_strbuf *out;
    kind last;
    bool tight; ///< a name or a digit of a script has just ended
    bool joins; ///< a digit belongs to the name before it: xi1
} speller;

static int find(const char *at) {
    for (int i = 0; i < N_SPELLINGS; i++) {
        if (strncmp(SPELLINGS[i].utf8, at, strlen(SPELLINGS[i].utf8)) == 0) {
            return i;
        }
    }
    return -1;
}

/// A blank where a name or a digit would join what stands before it.
static void keep_apart(speller *s) {
    const char last = s->out->n ? hn_strbuf_text(s->out)[s->out->n - 1] : ' ';
    if (isalnum((unsigned char)last) || last == '\'') {
        hn_strbuf_add(s->out, " ");
    }
}

static void put_spelling(speller *s, int i) {
    const kind k = SPELLINGS[i].kind;
    if (k == NAME) {
        keep_apart(s);
    } else if ((k == RAISED || k == LOWERED) && s->last != k) {
        hn_strbuf_add(s->out, k == RAISED ? "^" : "_");
    }
    hn_strbuf_add(s->out, SPELLINGS[i].ascii);
    s->last = k;
    s->tight = k != SIGN || SPELLINGS[i].ascii[0] == '\'';
}

/// The next character of ASCII, apart from a name before it; so is a letter with an accent.
static void put_character(speller *s, const char *at) {
    const int next = find(at + 1);
    const bool accented = next >= 0 && SPELLINGS[next].kind == ACCENT;
    const bool joined = s->joins && isdigit((unsigned char)*at);
    if ((s->tight || accented) && !joined && isalnum((unsigned char)*at)) {
        keep_apart(s);
    }
    hn_strbuf_add_n(s->out, at, 1);
    s->last = SIGN;
    s->tight = false;
}

static void spell(speller *s, const char *utf8) {
    while (*utf8) {
        const int i = find(utf8);
        if (i >= 0) {
            put_spelling(s, i);
            utf8 += strlen(SPELLINGS[i].utf8);
        } else {
            put_character(s, utf8++);
        }
    }
}

void hn_spell_out(hn_strbuf *b, const char *utf8, bool joins) {
    speller s = {.out = b, .last = SIGN, .joins = joins};
    spell(&s, utf8);
}
