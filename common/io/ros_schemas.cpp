// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/ros_messages.hpp"

// The definitions are those of ROS 2 (builtin_interfaces, std_msgs, geometry_msgs, sensor_msgs) without
// comments.
#define EDGESPLAT_SEPARATOR \
  "================================================================================\n"
#define EDGESPLAT_TIME             \
  EDGESPLAT_SEPARATOR              \
  "MSG: builtin_interfaces/Time\n" \
  "int32 sec\n"                    \
  "uint32 nanosec\n"
#define EDGESPLAT_HEADER            \
  EDGESPLAT_SEPARATOR               \
  "MSG: std_msgs/Header\n"          \
  "builtin_interfaces/Time stamp\n" \
  "string frame_id\n" EDGESPLAT_TIME

namespace edgesplat::io {

const RosSchema kRawDatagramSchema{"edgesplat_msgs/msg/RawDatagram", "uint8[] data\n"};

const RosSchema kFrameMetaSchema{"edgesplat_msgs/msg/FrameMeta",
                                 "builtin_interfaces/Time stamp\n"
                                 "uint32 sequence\n"
                                 "float32 exposure_s\n"
                                 "float32 gain_db\n"
                                 "uint8 stamp_source\n" EDGESPLAT_TIME};

const RosSchema kCompressedImageSchema{"sensor_msgs/msg/CompressedImage",
                                       "std_msgs/Header header\n"
                                       "string format\n"
                                       "uint8[] data\n" EDGESPLAT_HEADER};

const RosSchema kPoseStampedSchema{"geometry_msgs/msg/PoseStamped",
                                   "std_msgs/Header header\n"
                                   "geometry_msgs/Pose pose\n" EDGESPLAT_HEADER EDGESPLAT_SEPARATOR
                                   "MSG: geometry_msgs/Pose\n"
                                   "geometry_msgs/Point position\n"
                                   "geometry_msgs/Quaternion orientation\n" EDGESPLAT_SEPARATOR
                                   "MSG: geometry_msgs/Point\n"
                                   "float64 x\n"
                                   "float64 y\n"
                                   "float64 z\n" EDGESPLAT_SEPARATOR
                                   "MSG: geometry_msgs/Quaternion\n"
                                   "float64 x\n"
                                   "float64 y\n"
                                   "float64 z\n"
                                   "float64 w\n"};

}  // namespace edgesplat::io
