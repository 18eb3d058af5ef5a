// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/glossary.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

static const hn_glossary_term TERMS[] = {
    // loops
    {"loop gap, constraint violation",
     "Distance between the two halves of the joints at which the loops are cut to write their "
     "equations phi = 0. It is 0 while the loops are closed."},
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
    {"degrees of freedom", "Number of velocities minus number of independent constraints: nv - "
                           "rank J."},
    {"lambda_mark",
     "The mark that every set of multipliers comes with. 0: they are unique; 1: rows depend on "
     "each other, and these are one choice of many; 2: they have no correct digit; 3: they do not "
     "exist; 4: they are those of open loops."},
    {"load",
     "A force or moment of a damper, a drive, or one that is applied from outside. Gravity and "
     "springs without damping are none: they are part of the energy."},
    {"mechanism's length, characteristic length",
     "One length for the size of a mechanism, computed from its bodies and joints. Gaps and errors "
     "are compared with it, so that a small mechanism is judged as a large one."},
    {"consistent start",
     "Start values of coordinates and velocities that satisfy phi = 0 and J v + phi_t = 0. "
     "Assembly computes them from the values that the scene gives."},
    {"branch, assembly mode",
     "One of the ways in which the same links can be put together, as 'open' and 'crossed' of a "
     "four-bar. A method can jump to another one with its loops closed."},

    // singular configurations
    {"J loses rank, dependent constraints",
     "In some configurations, for example with links in line, one closure equation follows from "
     "the others. There the mechanism can have one more degree of freedom, the motion may branch "
     "or lock, and single multipliers are not determined."},
    {"singular configuration",
     "A configuration in which J loses rank: a change point, a flat linkage. At a dead point J "
     "keeps "
     "its rank; there only one coordinate no longer determines the others."},
    {"sigma_min",
     "The smallest singular value of J: how close the constraints are to dependent. It is 0 in a "
     "singular configuration, and is compared with the largest one, sigma_max."},
    {"scaled J", "J with each column divided by the root of the mass that belongs to its velocity, "
                 "and each row by the largest length that it has had. Its singular values are pure "
                 "numbers, whatever the units of the coordinates."},
    {"pivot ratio",
     "Smallest pivot met in solving for the multipliers, divided by the sum of the absolute values "
     "of its terms: another measure of how close the constraints are to dependent. 1 is far, 0 is "
     "singular."},
    {"condition number",
     "By how much the equations can magnify a relative error: with 1e6, six of sixteen digits of "
     "the multipliers are lost."},
    {"pilot run",
     "A second run by a robust and tighter method, at the same times as the run that is shown or "
     "ahead of it. It detects singular configurations ahead, tries remedies, and gives the error "
     "estimate."},
    {"chart, independent coordinates",
     "The coordinates that a method steps; the others follow from the loops. At a turning point of "
     "an independent coordinate another one has to take its place."},

    // errors
    {"error estimate, motion error, reaction error",
     "Largest difference of a run from its pilot run so far. The motion error takes angles in rad "
     "and lengths divided by the mechanism's length; the reaction error is divided by the largest "
     "reaction."},
    {"right, inaccurate, WRONG",
     "The verdict of 'run' and 'compare', by the error estimate. right: motion error and reaction "
     "error are at most 0.01. inaccurate: one of them is larger. WRONG: the motion error is 1 or "
     "more, a radian or the mechanism's length. 'ok' says only that the run reached its end."},
    {"not judged",
     "There is no error estimate for the end of the run: the pilot run ended earlier, would have "
     "cost too much, or was itself too uncertain. The reason is given."},
    {"right to 3 digits",
     "The verdict of the workbench and the page, at the time shown. It is the larger of two "
     "errors: the distance of drawn points from the reference solution, divided by the "
     "mechanism's length, and the energy change, divided by the range of the energies."},
    {"incident, remedy",
     "An incident is an event that the program reports during a run, such as a loop that opens or "
     "an energy that jumps. A remedy is a change of method or step that removes it; 'tried' gives "
     "the result of the pilot run with it."},
    {"gap limit",
     "The loop gap from which a loop is reported as open: 0.001 of the mechanism's length."},
    {"reference solution", "The motion, computed at a very tight tolerance in two ways that share "
                           "no code but that of the "
                           "equations. The digits on which both agree count as true."},
    {"energy change",
     "Kinetic and potential energy now, minus their value at the start, minus the work of drives, "
     "dampers and loads. The true value is 0."},
    {"drift", "An error that grows with every step because nothing in the equations corrects it."},
    {"rtol, tolerance",
     "The relative error that a method with a variable step allows in one step. The error of a "
     "whole run is larger."},
    {"stiff",
     "A part of the motion is much faster than the rest and too small to see. Explicit methods "
     "must take steps short enough to follow it, implicit methods need not."},

    // cost
    {"evals",
     "Evaluations: how often accelerations, or residuals of an implicit step, were computed."},
    {"ops", "Arithmetic operations, counted exactly: the same on every machine."},
    {"quartiles", "Two times: a quarter of the measured steps took less than the first one, a "
                  "quarter took more than the second one."},
    {"compiled instructions, tape",
     "The list of arithmetic instructions to which the equations of a scene are compiled. It is "
     "interpreted at first, and replaced by machine code where a C compiler is installed."},
};

const hn_glossary_term *hn_glossary(int *n) {
    *n = (int)(sizeof TERMS / sizeof *TERMS);
    return TERMS;
}

/// Returns whether `text` holds the word, not as a part of a longer one.
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

hn_term_match hn_term_matches(const hn_glossary_term *term, const char *word) {
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

bool hn_term_is_in(const hn_glossary_term *term, const char *text) {
    char name[64];
    for (const char *at = term->word; *at;) {
        const size_t n = strcspn(at, ",");
        snprintf(name, sizeof name, "%.*s", (int)n, at);
        if (n > 1 && holds_word(text, name)) { // "J" is a unit too
            return true;
        }
        at += n;
        at += strspn(at, ", ");
    }
    return false;
}
