// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/glossary.h"

#include <ctype.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>
#include <strings.h>

static const hn_term TERMS[] = {
    // loops
    {"loop gap, constraint violation",
     "Distance between the two halves of the joints at which loops are cut open to write their "
     "equations phi = 0. A closed mechanism has none."},
    {"velocity gap, velocity violation", "How fast the loops come apart: the norm of J v + phi_t."},
    {"J", "The matrix of the constraints: a row for each closure equation, a column for each "
          "velocity. J v + phi_t = 0 keeps the loops closed."},
    {"lambda, multipliers",
     "One number for each closure equation: the force or moment that holds the loop closed. "
     "J' lambda are these forces along the coordinates."},
    {"alpha, beta",
     "The constants [1/s] of Baumgarte's method: it asks for phi'' + 2 alpha phi' + beta^2 phi = "
     "0, "
     "so that a loop gap dies away as a damped vibration does. With alpha = beta it falls about "
     "as exp(-alpha t); with alpha below beta it swings meanwhile; with alpha above beta it falls "
     "more slowly in the end, as exp(-(alpha - sqrt(alpha^2 - beta^2)) t)."},
    {"degrees of freedom", "Velocities less independent constraints: nv - rank J."},
    {"branch, assembly mode",
     "One of the ways in which the same links can be put together, as 'open' and 'crossed' of a "
     "four-bar. A method can jump to another one with its loops closed."},

    // singular configurations
    {"J loses rank, dependent constraints",
     "In some configurations (links in line) one closure equation follows from the others. There "
     "the mechanism can have one more degree of freedom, the motion may branch or lock, and single "
     "multipliers are not determined."},
    {"singular configuration",
     "A configuration in which J loses rank: a change point, a flat linkage. At a dead point J "
     "keeps "
     "its rank; there only one coordinate no longer determines the others."},
    {"sigma_min",
     "The smallest singular value of J: how close the constraints are to dependent. It is 0 in a "
     "singular configuration, and is compared with the largest one, sigma_max."},
    {"pivot ratio",
     "Smallest over largest pivot met in solving for the multipliers: another measure of how close "
     "the constraints are to dependent. 1 is far, 0 is singular."},
    {"condition number",
     "By how much the equations can magnify a relative error: with 1e6, six of sixteen digits of "
     "the multipliers are lost."},
    {"pilot run",
     "A second run by a robust method, beside or ahead of the one that is shown. It foresees "
     "singular configurations, tries remedies, and gives the error estimate."},
    {"chart, independent coordinates",
     "The coordinates that a method steps; the others follow from the loops. At a turning point of "
     "an independent coordinate another one has to take its place."},

    // errors
    {"error estimate",
     "Largest difference of a run from its pilot run so far, relative: angles in rad, lengths over "
     "the mechanism's length, reactions over their largest value."},
    {"right, inaccurate, WRONG",
     "The verdict by the error estimate: up to 1 %, above, and from 1 on (a radian, or the "
     "mechanism's length). 'ok' says only that the run came to its end."},
    {"right to 3 digits",
     "The verdict of the workbench and the page, at the time shown: the worse of the distance of "
     "drawn points from the reference solution, over the mechanism's length, and of the energy "
     "change over the range of the energies."},
    {"reference solution",
     "The motion computed in two ways without common code, at very tight tolerance. The digits on "
     "which both agree count as true."},
    {"energy change",
     "Kinetic and potential energy now less those at the start, less the work of drives, dampers "
     "and loads. The true change is 0."},
    {"drift", "An error that grows with every step, as nothing in the equations pushes it back."},
    {"rtol, tolerance",
     "What a method that chooses its own steps allows as relative error of one step; the error of "
     "a whole run is larger."},
    {"stiff",
     "Some part of the motion is much faster than what can be seen. Explicit methods must take "
     "steps that follow it, implicit methods need not."},

    // cost
    {"evals", "How often accelerations, or residuals of an implicit step, were computed."},
    {"ops", "Arithmetic operations, counted exactly: the same on every machine."},
    {"quartiles", "A quarter of the steps was measured faster than the first time, a quarter "
                  "slower than the second."},
};

const hn_term *hn_glossary(int *n) {
    *n = (int)(sizeof TERMS / sizeof *TERMS);
    return TERMS;
}

/// Whether `text` holds the word, not as a part of a longer one.
static bool holds_word(const char *text, const char *word) {
    const size_t n = strlen(word);
    for (const char *at = text; n > 0 && *at; at++) {
        const bool begins = at == text || !isalnum((unsigned char)at[-1]);
        if (begins && strncasecmp(at, word, n) == 0 && !isalnum((unsigned char)at[n])) {
            return true;
        }
    }
    return false;
}

hn_term_match hn_term_matches(const hn_term *term, const char *word) {
    // the names stand in one text with commas between
    for (const char *name = term->word; *name;) {
        const size_t n = strcspn(name, ",");
        if (strlen(word) == n && strncasecmp(name, word, n) == 0) {
            return HN_TERM_IS;
        }
        name += n;
        name += strspn(name, ", ");
    }
    return holds_word(term->word, word)    ? HN_TERM_HOLDS
           : holds_word(term->means, word) ? HN_TERM_TELLS
                                           : HN_TERM_OTHER;
}
