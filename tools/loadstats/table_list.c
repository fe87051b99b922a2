/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <assert.h>
#include <string.h>
#include "plot_ensemble.h"
#include "plot_levels.h"
#include "plot_parts.h"
#include "plot_pressure.h"
#include "plot_rainflow.h"
#include "plot_regimes.h"
#include "plot_response.h"
#include "plot_spectrum.h"
#include "table_fits.h"
#include "table_list.h"
#include "table_overview.h"
#include "table_parts.h"
#include "table_pressure.h"
#include "table_rainflow.h"
#include "table_regimes.h"
#include "table_response.h"
#include "table_spectrum.h"
#include "table_stats.h"
#include "table_summary.h"

#define RUN_LABELS "part\tsignal\tunit"
#define LABELS RUN_LABELS "\tview"

/* The first kind is the default; pictures of a part are drawn in this order. */
static const struct table TABLES[] = {
    {.name = "stats",
     .uses = USES_QUANTILES,
     .columns = LABELS "\tfrom[s]\tto[s]\trows\tmean\tstd\tskew\tkurtosis\tmin\tmax\tt_max[s]",
     .more_columns = stats_more_columns,
     .view_rows = stats_rows,
     .run_rows = stats_of_runs,
     .follows = 1,
     .report = {.position = 2, .heading = "Numbers", .layout = LAYOUT_TRANSPOSED}},
    {.name = "overview",
     .uses = USES_SAMPLE | USES_RETURNS,
     .columns = LABELS "\tmean\tmean_low\tmean_high\tstd\tmin\tmax\tlargest\tq95\tpeaks\tT[s]\tlaw\tlevel"
                       "\tlevel_low\tlevel_high\ttau[s]\tindependent",
     .view_rows = overview_rows,
     .report =
         {.position = 1,
          .heading = "Overview",
          .note =
              "Forces in kN, moments in kN.m. Mean with its 95 % interval, by the integral time tau of "
              "the record; smallest and largest value; the value that is not "
              "passed for 95 % of the time, on the side of the largest magnitude; and the level that is "
              "exceeded once in T on average, of the distribution of the separate peaks that fits best, "
              "with its 95 % interval. There is none for fewer than 30 peaks: then the largest value is "
              "one event of one scene. Nor is there one where no interval ends below ten times its level.",
          .layout = LAYOUT_OVERVIEW}},
    {.name = "peaks", .columns = LABELS "\tt[s]\tpeak", .view_rows = peaks_rows},
    {.name = "histogram",
     .uses = USES_BINS,
     .columns = LABELS "\tfrom\tto\ttime[s]\tshare\tpeaks",
     .signal_rows = histogram_rows,
     .run_rows = histogram_of_runs},
    {.name = "exceedance", .columns = LABELS "\trank\tpeak\tP", .view_rows = exceedance_rows},
    {.name = "fits",
     .uses = USES_SAMPLE,
     .columns =
         LABELS "\tsample\tn\tlaw\tmethod\tlocation\tscale\tshape\tlogL\tAIC\tks\tks_p\tad\tad_p\trank",
     .view_rows = fits_rows,
     .run_rows = fits_of_runs,
     .report = {.position = 5,
                .heading = "Distributions of the peaks",
                .heading_of_runs = "Distributions of the largest values",
                .layout = LAYOUT_FITS}},
    {.name = "levels",
     .uses = USES_SAMPLE | USES_RETURNS,
     .needs = NEEDS_RETURNS,
     .columns = LABELS
     "\tsample\tn\tlaw\tT[s]\tlevel\tprofile_low\tprofile_high\tbootstrap_low\tbootstrap_high\trecords\trank",
     .view_rows = levels_rows,
     .run_rows = fits_of_runs,
     .picture = &levels_picture,
     .report = {.position = 6, .heading = "Return levels"}},
    {.name = "legs",
     .uses = USES_LEVEL,
     .columns = LABELS "\tmean\tstd\tmin\tmax\tt_max[s]\tpeak_third\tpeak_tenth\timpulse\tabove[s]"
                       "\tpeaks\trise[s]\tduration[s]\tmean_ratio\tmax_ratio\tat_total\tsimultaneity",
     .view_rows = legs_rows,
     .by_signal = 1,
     .picture = &parts_picture,
     .report = {.position = 3,
                .needs = NEEDS_PARTS,
                .heading = "Parts side by side",
                .note = "Ratios are relative to the part with the largest load. at_total is the value at the "
                        "moment the total is largest, simultaneity its ratio to the largest value of the "
                        "part; for the total, the ratio of its largest value to the sum of those of the "
                        "parts. Rise and duration are means over the peaks."}},
    {.name = "events",
     .uses = USES_LEVEL,
     .columns = LABELS "\tt[s]\tpeak\tfrom[s]\tto[s]\trise[s]\tfall[s]\tduration[s]\timpulse",
     .view_rows = events_rows},
    {.name = "rainflow",
     .uses = USES_BINS | USES_RULE,
     .columns = LABELS "\trule\tresidue\trange_from\trange_to\tmean_from\tmean_to\tcycles",
     .signal_rows = rainflow_rows,
     .picture = &rainflow_picture},
    {.name = "damage",
     .uses = USES_RULE | USES_SN,
     .columns = LABELS "\trule\tresidue\tcycles\trange_max\tm\ta\tm2\tknee\tequivalent\tdamage\tlife[s]",
     .signal_rows = damage_rows,
     .run_rows = damage_of_runs,
     .picture = &rainflow_picture,
     .report = {.position = 8,
                .heading = "Fatigue",
                .note = "Cycles by the named rule, with their residue; the equivalent range does the same "
                        "damage with the same number of cycles."}},
    {.name = "spectrum",
     .uses = USES_SEGMENT,
     .columns = LABELS "\twindow\tsegment[s]\tsegments\tf[Hz]\tpsd[unit^2/Hz]\tpsd_low\tpsd_high",
     .view_rows = spectrum_rows,
     .picture = &spectrum_picture,
     .report = {.needs = NEEDS_SEGMENT}},
    {.name = "frequency",
     .uses = USES_SEGMENT | USES_SPEED,
     .columns = LABELS "\twindow\tsegment[s]\tsegments\tdf[Hz]\tenbw[Hz]\tdof\tvariance\tpower\tf[Hz]\tpsd["
                       "unit^2/Hz]\tshare\tcrossings[Hz]\tlength[m]",
     .view_rows = frequency_rows,
     .picture = &spectrum_picture,
     .report = {.position = 7,
                .needs = NEEDS_SEGMENT,
                .heading = "Frequencies",
                .note = "From Welch's spectrum: share is the fraction of the variance within two steps df of "
                        "the dominant frequency f; where it is small, no frequency dominates.",
                .layout = LAYOUT_TRANSPOSED}},
    {.name = "response",
     .uses = USES_OSCILLATOR | USES_SEGMENT,
     .needs = NEEDS_OSCILLATOR,
     .columns = LABELS "\tfn[Hz]\tdamping\tstiffness[unit/"
                       "m]\tstatic\tdynamic\tamplification\tt_max[s]\tstd_ratio\tx_static[m]\tx_max[m]\ta_"
                       "max[m/s^2]\tf[Hz]\tshare\tlock_in\tstep[s]\terror",
     .view_rows = response_rows,
     .picture = &response_picture,
     .report = {.position = 9,
                .needs = NEEDS_RECORD,
                .heading = "Response of an oscillator",
                .note = "Lock-in is flagged where the dominant frequency of the load is within 10 % of the "
                        "natural one.",
                .layout = LAYOUT_TRANSPOSED}},
    {.name = "motion",
     .uses = USES_OSCILLATOR,
     .needs = NEEDS_OSCILLATOR,
     .columns = LABELS "\tfn[Hz]\tdamping\tt[s]\tload\tresponse\tx[m]\tv[m/s]\ta[m/s^2]",
     .view_rows = motion_rows,
     .picture = &response_picture},
    {.name = "regimes",
     .uses = USES_SEGMENT | USES_SPEED | USES_MODES,
     .needs = NEEDS_MODES,
     .columns = "part\tfrom[s]\tto[s]\tregime\tmode[Hz]\tspeed[m/s]\tbeta\tpeak\tf[Hz]\tload[N]\tload_std[N]"
                "\tload_max[N]\tx_mean[m]\tx_std[m]\tbreaks",
     .view_rows = regime_rows,
     .picture = &regimes_picture},
    {.name = "regime-shares",
     .uses = USES_SEGMENT | USES_SPEED | USES_MODES | USES_RULE | USES_SN,
     .needs = NEEDS_MODES,
     .columns = "part\tregime\tmode[Hz]\twindows\tshare\tslowest[m/s]\tfastest[m/s]\tbeta_max\tload[N]"
                "\tload_max[N]\tcycles\trange_max[m]\tm\tequivalent[m]",
     .view_rows = regime_share_rows,
     .picture = &regimes_picture},
    {.name = "pressure-area",
     .source = FROM_CONTACTS,
     .uses = USES_AREAS,
     .columns = "part\tarea[m2]\tp_max[Pa]\tp_mean[Pa]\tF_max[N]\tt_max[s]\tx[m]\ty[m]\tz[m]\tcontacts\tfit["
                "Pa]\tiso_19906[Pa]",
     .contact_rows = pressure_rows,
     .contact_picture = &pressure_picture,
     .report = {.note = "The largest force on a circular window of given area anywhere on the structure, "
                        "divided by the area."}},
    {.name = "line-load",
     .source = FROM_CONTACTS,
     .uses = USES_WATERLINE,
     .needs = NEEDS_WATERLINE,
     .columns = "from[m]\tto[m]\tx[m]\ty[m]\tq_mean[N/m]\tq_max[N/m]\tt_max[s]\tloaded",
     .contact_rows = line_rows,
     .contact_picture = &line_picture,
     .report = {.note = "The load along the waterline: horizontal inward force per length of each section."}},
    {.name = "map",
     .source = FROM_CONTACTS,
     .uses = USES_WATERLINE | USES_HEIGHTS,
     .columns = "panel\tfrom[m]\tto[m]\tbottom[m]\ttop[m]\tx[m]\ty[m]\tz[m]\tarea[m2]\tp_mean[Pa]\tp_max[Pa]"
                "\tt_max[s]\tloaded",
     .contact_rows = map_rows,
     .contact_picture = &map_picture,
     .report = {.note = "The load on panels: force on each panel divided by its area."}},
    {.name = "summary", .source = FROM_RUNS}, /* summary_file.h writes it */
    {.name = "ensemble",
     .source = FROM_RUNS,
     .uses = USES_BLOCK,
     .columns = RUN_LABELS "\truns\tmean\tmean_low\tmean_high\tmean_std\tmax\tmax_low\tmax_high\tmax_"
                           "std\tlargest\tsmallest\tmagnitude\truns_mean_5%\truns_max_5%",
     .run_rows = ensemble_rows,
     .per_run = 1,
     .draw_runs = plot_ensemble,
     .report = {.position = 4,
                .needs = NEEDS_RUNS,
                .heading = "Confidence of the estimates",
                .note = "The first n runs: mean of their means and mean of their largest values, each with "
                        "its 95 % interval, corrected for skewness, and the standard deviation between runs.",
                .layout = LAYOUT_RUNS}},
    {.name = "cycles",
     .source = FROM_RUNS,
     .uses = USES_RULE,
     .columns = RUN_LABELS "\trule\tresidue\tfrom\tto\tcycles",
     .run_rows = cycles_of_runs}};

enum { COUNT = sizeof TABLES / sizeof *TABLES };
_Static_assert((int)COUNT <= (int)TABLES_MAX, "options.c holds the names of all kinds");

int table_count(void) { return COUNT; }

const struct table *table_at(int k) { return &TABLES[k]; }

const struct table *table_default(void) { return &TABLES[0]; }

const struct table *table_named(const char *name)
{
    int k = 0;
    while (k < COUNT && strcmp(TABLES[k].name, name) != 0) k++;
    assert(k < COUNT);
    return &TABLES[k];
}

const struct table *table_in_report(int position)
{
    for (int k = 0; k < COUNT; k++)
        if (TABLES[k].report.position == position) return &TABLES[k];
    return NULL;
}

unsigned table_report_uses(void)
{
    unsigned uses = 0;
    for (int k = 0; k < COUNT; k++)
        if (TABLES[k].report.position && TABLES[k].source == FROM_RECORD) uses |= TABLES[k].uses;
    return uses;
}
