/* SPDX-License-Identifier: GPL-3.0-or-later */
/* analyse_contacts.h -- loads by place: tables, pictures and report from contacts or panels. */
#ifndef LOADSTATS_ANALYSE_CONTACTS_H
#define LOADSTATS_ANALYSE_CONTACTS_H
#include "base/err.h"
#include "settings.h"

/* Read the input and write table, pictures and report.  0, or -1 with err. */
int analyse_contacts(const struct options *o, fl_err *err);

#endif
