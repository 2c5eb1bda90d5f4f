// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "report/packed.h"

namespace articap {

// A template (report/page_template.h) with its title and its data: names from files can neither
// end an element nor begin one, and what is not UTF-8 in them is replaced.
std::string FillPage(std::string_view page_template, std::string_view title, const Json& data);

}  // namespace articap
