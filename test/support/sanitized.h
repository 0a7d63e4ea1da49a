// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// SEGORIENT_ADDRESS_SANITIZER is defined where a test is built with the address sanitizer, which
// takes most of the address space for itself: memory can not be limited there.
#pragma once

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SEGORIENT_ADDRESS_SANITIZER
#endif
#endif
#ifdef __SANITIZE_ADDRESS__
#define SEGORIENT_ADDRESS_SANITIZER
#endif
