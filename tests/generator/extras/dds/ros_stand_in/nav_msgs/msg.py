from cdr import Message
from geometry_msgs.msg import Header, Quaternion, Twist, Vector3


class Pose(Message):
    FIELDS = (("position", Vector3), ("orientation", Quaternion))


class PoseWithCovariance(Message):
    FIELDS = (("pose", Pose), ("covariance", ("float64", 36)))


class TwistWithCovariance(Message):
    FIELDS = (("twist", Twist), ("covariance", ("float64", 36)))


class Odometry(Message):
    DDS = "nav_msgs::msg::dds_::Odometry_"
    FIELDS = (("header", Header), ("child_frame_id", "string"), ("pose", PoseWithCovariance),
              ("twist", TwistWithCovariance))
