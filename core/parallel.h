// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

namespace articap {

// Calls work(0) ... work(num_items - 1), each once, on `threads` threads (0: one a processor), in
// an order that is not fixed; returns when all are done. What an item does must depend on nothing
// else.
void ParallelFor(int num_items, int threads, const std::function<void(int item)>& work);

}  // namespace articap
