// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/parts/latex_letters.h"

#include <ctype.h>
#include <string.h>

static const char *const GREEK[] = {
    "alpha",   "beta",   "gamma", "delta",   "epsilon", "zeta",  "eta",   "theta", "iota",
    "kappa",   "lambda", "mu",    "nu",      "xi",      "pi",    "rho",   "sigma", "tau",
    "upsilon", "phi",    "chi",   "psi",     "omega",   "Gamma", "Delta", "Theta", "Lambda",
    "Xi",      "Pi",     "Sigma", "Upsilon", "Phi",     "Psi",   "Omega", NULL};
static const char *const VARIANTS[] = {"varphi", "vartheta", "varepsilon", "varrho", NULL};

bool hn_latex_is_word(const char *at, const char *const *words) {
    size_t n = 0;
    while (isalpha((unsigned char)at[n])) {
        n++;
    }
    for (int i = 0; words[i]; i++) {
        if (strlen(words[i]) == n && strncmp(at, words[i], n) == 0) {
            return true;
        }
    }
    return false;
}

bool hn_latex_is_variant(const char *at) {
    return hn_latex_is_word(at, VARIANTS);
}

bool hn_latex_is_letter(const char *at) {
    return hn_latex_is_word(at, GREEK) || hn_latex_is_variant(at);
}
