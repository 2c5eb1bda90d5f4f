// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace articap {

// The page without its data, made of report/page/ when articap is built: HTML with its style and
// its script, holding the marks {{articap:title}} and {{articap:data}}.
std::string_view PageTemplate();

}  // namespace articap
