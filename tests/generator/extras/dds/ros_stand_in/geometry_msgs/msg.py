from builtin_interfaces.msg import Time
from cdr import Message


class Header(Message):
    FIELDS = (("stamp", Time), ("frame_id", "string"))


class Vector3(Message):
    FIELDS = (("x", "float64"), ("y", "float64"), ("z", "float64"))


class Quaternion(Message):
    FIELDS = Vector3.FIELDS + (("w", "float64"),)


class Twist(Message):
    FIELDS = (("linear", Vector3), ("angular", Vector3))


class TwistStamped(Message):
    DDS = "geometry_msgs::msg::dds_::TwistStamped_"
    FIELDS = (("header", Header), ("twist", Twist))
