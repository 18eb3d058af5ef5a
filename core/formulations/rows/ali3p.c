#include "formulations/ground/registry.h"

// M a - f + J' lambda* = 0 with lambda* := lambda* + w phi until phi = 0; then speeds and accelerations are projected with the
// matrix of that iteration (integrators/trapezoidal.c).

static const char *const projections[] = {"on", "off"};

const hn_formulation hn_formulation_ali3p = {
    .name = "ali3p",
    .title = "index-3 augmented Lagrangian with projections",
    .short_name = "ALI3-P",
    .rule = "Push the gap back with a strong spring, add what it pushed to the loop force, and "
            "repeat until nothing is left to push; then take from speeds and accelerations what "
            "the loop forbids.",
    .traits = HN_TRAIT_CLOSES_POSITION | HN_TRAIT_CLOSES_VELOCITY,
    .drift = "none in the gap; the speed gap is left at about 1 / weight",
    .when = "redundant rows, passing poses where the loop loses rank, real time with a fixed step",
    .when_not = "digits beyond order 2; energy: the projections take a little of it",
    .source = "Bayo & Ledesma 1996; Cuadrado, Cardenal & Bayo 1997; Dopico et al. 2014",
    .needs = "M f phi J gamma and derivatives",
    .order_note = "2 in q, v and recomputed lambda",
    .limits = "without projections its multipliers and speeds are unstable, an exhibit",
    .form = HN_FORM_AUGMENTED,
    .index = 3,
    .n_settings = 2,
    .settings =
        {
            {"weight", 0, 0, 1e18, "",
             "weight of the gap; 0: chosen so that each turn shrinks it a thousandfold", NULL, 0,
             0},
            {"projections", 0, 0, 1, "", "of speeds and accelerations after each step", projections,
             2, 0},
        },
};
