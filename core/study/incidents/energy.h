// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_ENERGY_INCIDENTS
#define HN_STUDY_ENERGY_INCIDENTS
// Incidents of the energy of conservative scenes.

#include "study/incidents/watch.h"

extern const hn_incident_kind hn_incident_energy_drift, hn_incident_energy_jump;
/// Returns whether no load does work that the energy of the scene does not contain.
bool hn_energy_is_conservative(const hn_system *sys);
/// Begins the record with the state measured last.
void hn_energy_start(hn_watch *w);
/// Adds the state measured last to the record.
void hn_energy_record_state(hn_watch *w);
/// Appends to the reason of a failed iteration that the energy has long been wrong, where it is.
void hn_energy_explain(const hn_watch *w, char why[256]);
/// End of the sentence of that reason.
#define HN_ENERGY_ANOTHER "so this is no longer the motion that began"

#endif
