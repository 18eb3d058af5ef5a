// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_GSL_CONTROL_H
#define HN_INTEGRATORS_GSL_CONTROL_H
// The step control of the GNU Scientific Library with the tolerances of control.h: units of atol,
// and angles that count from the nearest whole turn. If neither matters its steps are the
// library's own, bit for bit.

#include "integrators/step/control.h"

#include <gsl/gsl_odeiv2.h>

/// Creates a control for n entries; the arrays of `tol` must outlive it. Free it with
/// gsl_odeiv2_control_free(). Returns NULL when memory is out.
gsl_odeiv2_control *hn_gsl_control_create(const hn_tolerance *tol, int n);

#endif
