// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Marks maths that host and device code share, so that CPU tests cover what the GPU runs.
#ifdef __CUDACC__
#define EDGESPLAT_HOST_DEVICE __host__ __device__
#else
#define EDGESPLAT_HOST_DEVICE
#endif
