/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <inttypes.h>
#include <string.h>
#include "base/decimal.h"
#include "out/frame_state.h"

static const char COLUMN_NAMES[] =
    "t[s]\tbody\tx[m]\ty[m]\tz[m]\tqw\tqx\tqy\tqz\tvx[m/s]\tvy[m/s]\tvz[m/s]\twx[rad/s]\twy["
    "rad/s]\twz[rad/s]";

void fl_frame_state_end(fl_frame_state *s, int64_t offset)
{
    if (!s->d->frames || !s->time[0]) return;
    fl_frame_entry *e = &s->d->frame[s->d->frames - 1];
    e->size = offset - e->at;
}

int fl_frame_state_line(fl_frame_state *s, const char *at, const char *end, int64_t offset, fl_err *err)
{
    fl_frame_entry e = {.at = offset, .line = ++s->line, .bodies = 1};
    if (end > at && end[-1] == '\r') end--;
    if (at == end || *at == '#') return 0;
    if (!s->in_rows) {
        if ((size_t)(end - at) != sizeof COLUMN_NAMES - 1 ||
            memcmp(at, COLUMN_NAMES, sizeof COLUMN_NAMES - 1) != 0)
            return fl_fail(err, FL_INPUT, "%s:%" PRId64 ": these are not the columns of a state", s->name,
                           s->line);
        s->in_rows = 1;
        return 0;
    }
    const char *tab = memchr(at, '\t', (size_t)(end - at));
    const size_t n = tab ? (size_t)(tab - at) : 0;
    if (n == 0 || n >= sizeof s->time)
        return fl_fail(err, FL_INPUT, "%s:%" PRId64 ": the row has no time", s->name, s->line);
    if (s->time[0] && memcmp(s->time, at, n) == 0 && s->time[n] == '\0') {
        s->d->frame[s->d->frames - 1].bodies++;
        return 0;
    }
    if (fl_decimal_read(at, &e.t) != tab || !(fabs(e.t) < 1e15))
        return fl_fail(err, FL_INPUT, "%s:%" PRId64 ": the time is no number", s->name, s->line);
    if (s->time[0] && e.t <= s->d->frame[s->d->frames - 1].t)
        return fl_fail(err, FL_INPUT, "%s:%" PRId64 ": time %g s does not follow %g s", s->name, s->line, e.t,
                       s->d->frame[s->d->frames - 1].t);
    fl_frame_state_end(s, offset);
    memcpy(s->time, at, n);
    s->time[n] = '\0';
    return fl_frame_data_add_frame(s->d, e, err);
}

int fl_frame_state_read(const fl_frame_entry *e, const char *name, const char *bytes, fl_frame_state_row *row,
                        void *to, fl_err *err)
{
    const char *at = bytes, *const end = bytes + e->size;
    int64_t line = e->line;
    for (; at < end; line++) {
        const char *stop = memchr(at, '\n', (size_t)(end - at)), *p = at;
        double x[FL_FRAME_STATE_COLUMNS];
        if (!stop) break;
        if (*at == '#' || stop == at) {
            at = stop + 1;
            continue;
        }
        for (int k = 0; k < FL_FRAME_STATE_COLUMNS; k++) {
            const char *next = fl_decimal_read(p, &x[k]);
            const int last = k + 1 == FL_FRAME_STATE_COLUMNS;
            if (!next || !(fabs(x[k]) < 1e15) || (last ? *next != '\n' && *next != '\r' : *next != '\t'))
                return fl_fail(err, FL_INPUT,
                               "%s:%" PRId64 ": column %d of the state is missing or no number", name, line,
                               k + 1);
            p = next + 1;
        }
        if (!(x[1] >= 0.0 && x[1] <= INT32_MAX && x[1] == floor(x[1])))
            return fl_fail(err, FL_INPUT, "%s:%" PRId64 ": %g is no number of a body", name, line, x[1]);
        if (row(to, line, (int32_t)x[1], v3(x[2], x[3], x[4]), (fl_quat){x[5], x[6], x[7], x[8]},
                v3(x[9], x[10], x[11]), v3(x[12], x[13], x[14]), err))
            return -1;
        at = stop + 1;
    }
    return 0;
}
