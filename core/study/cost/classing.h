// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_CLASSING_H
#define HN_STUDY_CLASSING_H
// Classes a method by its ladder of steps or tolerances: model error or discretisation error.
//
// Two distances of its finest points tell: that from the reference, and that from each other. If
// only the second falls, the method converges, but not to the motion of the scene. If neither
// falls, rounding or an inner tolerance is the floor.

#include "study/cost/workprecision.h"

#include <stdbool.h>

#define HN_CLASS_FROM_THEORY_FIXED 0.2 ///< observed order from theory's, with fixed steps
#define HN_CLASS_FROM_THEORY_ADAPTIVE \
    0.5                     ///< where steps are chosen: their number does not halve evenly
#define HN_CLASS_SPREAD 0.6 ///< of the slopes between neighbours within a straight part
#define HN_CLASS_OFFSET \
    1e-6                 ///< a smaller distance from the reference is a floor, not another model
#define HN_CLASS_APART 5 ///< distance from the reference over distance from each other

#define HN_CLASS_LIST(X)               \
    X(HN_CLASS_CONVERGES, "converges") \
    X(HN_CLASS_FLOOR, "floor")         \
    X(HN_CLASS_ELSEWHERE, "elsewhere") \
    X(HN_CLASS_UNSETTLED, "unsettled") \
    X(HN_CLASS_FAILED, "failed")
typedef enum hn_class_kind {
#define HN_CLASS_ENUM(code, name) code,
    HN_CLASS_LIST(HN_CLASS_ENUM)
#undef HN_CLASS_ENUM
        HN_CLASS_COUNT
} hn_class_kind;
/// The word of the documents.
const char *hn_class_name(hn_class_kind kind);

typedef struct hn_class {
    hn_class_kind kind;
    double order;        ///< of the coordinates against the number of steps; NaN: not found
    double theory;       ///< the integrator's; NaN: not known, of a program's own steps
    double energy_order; ///< the same of the energy's error; NaN: it is rounding
    double finest;       ///< slope between the last two points that were fitted
    bool as_theory;      ///< observed within the bounds above
    int first, last;     ///< points the order was fitted to, -1: none
    int rounding;        ///< first point behind the fitted ones that rounding bends; -1: none
    double low, high;    ///< slopes between neighbours that were met there
    double floor;        ///< largest error of the flat end; NaN: there is none
    double floor_size;   ///< coarsest size there
    double offset;       ///< elsewhere: distance of the limit from the reference
    double own;          ///< elsewhere: distance of the finest points from each other
    char text[480];      ///< in words
} hn_class;

/// Classes method m by the largest error of the coordinates over the run; nothing is said beyond
/// the horizon.
void hn_wp_classify(const hn_wp *wp, int m, hn_class *out);
#endif
