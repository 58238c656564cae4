from cdr import Message
from geometry_msgs.msg import Header


class PointField(Message):
    FIELDS = (("name", "string"), ("offset", "uint32"), ("datatype", "uint8"), ("count", "uint32"))


class PointCloud2(Message):
    DDS = "sensor_msgs::msg::dds_::PointCloud2_"
    FIELDS = (("header", Header), ("height", "uint32"), ("width", "uint32"),
              ("fields", [PointField]), ("is_bigendian", "bool"), ("point_step", "uint32"),
              ("row_step", "uint32"), ("data", ["uint8"]), ("is_dense", "bool"))
