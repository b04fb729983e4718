# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# Sourced after common.sh: where networks lie that scoring uses when they are there.

export EDGESPLAT_LPIPS=${EDGESPLAT_LPIPS-$root/../shared/models/lpips_alex}
export EDGESPLAT_MASK=${EDGESPLAT_MASK-$root/../shared/models/espnetv2_s2_city}
