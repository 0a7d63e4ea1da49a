// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// SEGORIENT_MEMORY_SANITIZED is defined where a test is built with the address or the thread
// sanitizer, which take most of the address space for themselves: memory can not be limited there.
#pragma once

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define SEGORIENT_MEMORY_SANITIZED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SEGORIENT_MEMORY_SANITIZED
#endif
