// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include "io/cloud_table.h"
#include "render/page/page.h"
#include "support/report_facts.h"

namespace segorient::program {

/// What a page shows of a cloud: all that it has. Its colours are left out where they are those of
/// its segments.
/// \param points of `table`; must outlive the result
PageCloud pageCloud(const CloudTable& table, const LocalPoints& points, const Facts& facts,
                    const std::string& title);

}  // namespace segorient::program
