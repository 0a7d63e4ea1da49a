// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/orientation_result.h>

namespace segorient {

const char* toString(DecidedBy by) {
  switch (by) {
    case DecidedBy::NOTHING:
      return "nothing";
    case DecidedBy::SEED:
      return "seed";
    case DecidedBy::PROPAGATION:
      return "propagation";
    case DecidedBy::BOUNDARY:
      return "boundary";
    case DecidedBy::EXTREMAL:
      return "extremal";
    case DecidedBy::ENCLOSURE:
      return "enclosure";
    case DecidedBy::SURROUNDINGS:
      return "surroundings";
    case DecidedBy::GLOBAL:
      return "global";
    case DecidedBy::HINTS:
      return "hints";
  }
  return "nothing";
}

}  // namespace segorient
