// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_STABILITY_STABILITY_DOC_H
#define HN_SESSION_STABILITY_STABILITY_DOC_H
// A stability map as JSON and as CSV.

#include "session/stability/stability.h"

/// Writes {"study","scene","time","finished","stopped","elapsed","x": axis,"y": axis,"methods":[
///  {"method","agreement":{...},"columns":[{"predicted","visible","last_stable","first_unstable",
///  ...}...],"rows":[[cell...]...]}...]}, rows from the smallest value of y on.
///
/// axis  {"name","unit","kind": "parameter", "step" or "setting","scale": "log" or "lin","values"}
/// cell  {"class","reason" if any,"t" reached [s],"error","energy","gap","steps","margin"}
///       error   largest velocity difference from the motion, in the energy norm and its scale
///       energy  largest energy above that of the motion, in its scale
///       gap     largest loop gap, in the characteristic length
///       margin  step over the predicted limit; above 1 unstable
/// error, energy and gap are the heat of a map where nothing is stiff, as over alpha and beta.
void hn_map_json(hn_strbuf *b, const hn_map *map);
void hn_map_csv(hn_strbuf *b, const hn_map *map); ///< one row a cell
#endif
