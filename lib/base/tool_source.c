/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/tool.h"

const char fl_tool_source[] = "unknown commit"; /* of programs linked without the build's own */
