package fresco.spy;

import info.monitorenter.gui.chart.Chart2D;
import info.monitorenter.gui.chart.IAxis;
import info.monitorenter.gui.chart.ITrace2D;
import info.monitorenter.gui.chart.ITracePoint2D;
import info.monitorenter.gui.chart.axis.AAxis;
import info.monitorenter.gui.chart.axis.AxisLinear;
import info.monitorenter.gui.chart.axis.scalepolicy.AxisScalePolicyManualTicks;
import info.monitorenter.gui.chart.labelformatters.LabelFormatterNumber;
import info.monitorenter.gui.chart.rangepolicies.RangePolicyFixedViewport;
import info.monitorenter.gui.chart.traces.Trace2DLtd;
import info.monitorenter.util.Range;
import java.awt.BorderLayout;
import java.awt.Color;
import java.awt.Font;
import java.awt.Stroke;
import java.text.DecimalFormat;
import java.text.DecimalFormatSymbols;
import java.util.Iterator;
import java.util.List;
import java.util.Locale;
import javax.swing.BorderFactory;
import javax.swing.JLabel;
import javax.swing.JPanel;

/** A chart of growing curves with a heading, axes with units and a legend. Used on the event thread. */
final class Curves extends JPanel {
  private static final long serialVersionUID = 1;
  private static final int POINTS = 4000; // of a curve; the oldest are dropped
  private static final int MOST_X_TICKS = 10;
  private static final int LEAST_TICKS = 2;
  private static final int DIGIT_PIXELS = 6;
  private static final int SPACE_PIXELS = 9; // between two numbers
  private static final int USUAL_MARGIN = 140; // beside what a chart draws
  private static final int TICK_PIXELS = 22; // from one number to the next one above it
  private static final int MOST_Y_TICKS = 6;
  private static final double SMALL_STEP = 1e-4; // of an axis; smaller ones need exponents
  private static final double LARGE_STEP = 1e6;
  private static final double ROUNDING = 1e-6; // of a step

  private final transient Chart2D chart = new Chart2D();
  private final JLabel label = new JLabel();
  private transient Range xRange = new Range(0, 1);

  Curves(String heading, String xTitle, String yTitle) {
    super(new BorderLayout());
    setBackground(Palette.SURFACE);
    setBorder(BorderFactory.createEmptyBorder(6, 8, 2, 8));
    label.putClientProperty("html.disable", true); // names come from the network
    label.setText(heading);
    label.setFont(label.getFont().deriveFont(Font.BOLD, 13f));
    label.setForeground(Palette.INK);
    add(label, BorderLayout.NORTH);
    chart.setBackground(Palette.SURFACE);
    chart.setForeground(Palette.MUTED);
    chart.setGridColor(Palette.LINE);
    chart.setUseAntialiasing(true);
    chart.setFont(chart.getFont().deriveFont(Font.PLAIN, 11f));
    chart.setToolTipType(Chart2D.ToolTipType.VALUE_SNAP_TO_TRACEPOINTS);
    chart.setAxisXBottom(axisWithOurTicks(), 0);
    chart.setAxisYLeft(axisWithOurTicks(), 0);
    prepare(chart.getAxisX(), xTitle); // now, since a new axis takes over the title of the old one
    prepare(chart.getAxisY(), yTitle);
    add(chart, BorderLayout.CENTER);
  }

  private static AAxis<?> axisWithOurTicks() {
    AxisLinear<AxisScalePolicyManualTicks> axis = new AxisLinear<>();
    axis.setAxisScalePolicy(new AxisScalePolicyManualTicks());
    return axis;
  }

  private static void prepare(IAxis<?> axis, String title) {
    axis.setAxisTitle(new IAxis.AxisTitle(title));
    axis.setPaintGrid(true);
    axis.setFormatter(formatter(1));
  }

  /** Returns what writes the numbers of an axis so that those of neighbouring ticks differ. */
  private static LabelFormatterNumber formatter(double step) {
    String pattern = step < SMALL_STEP || step > LARGE_STEP ? "0.###E0" : "#,##0.####";
    return new LabelFormatterNumber(
        new DecimalFormat(pattern, DecimalFormatSymbols.getInstance(Locale.ROOT))) {
      private static final long serialVersionUID = 1;

      @Override
      public String format(double value) {
        return Math.abs(value) < ROUNDING * step ? "0" : super.format(value);
      }
    };
  }

  /** Writes the names of many curves beside the chart instead of below it, where they take much height. */
  void nameBeside() {
    chart.setPaintLabels(false);
    add(new Legend(chart.getTraces()), BorderLayout.EAST);
  }

  void setTitles(String heading, String yTitle) {
    label.setText(heading);
    chart.getAxisY().getAxisTitle().setTitle(yTitle);
    repaint();
  }

  ITrace2D add(String name, Color colour, double width) { return add(name, colour, Palette.stroke(width)); }

  ITrace2D add(String name, Color colour, Stroke stroke) {
    ITrace2D trace = new Trace2DLtd(POINTS, name);
    trace.setColor(colour);
    trace.setStroke(stroke);
    trace.setPhysicalUnits("", "");
    chart.addTrace(trace);
    trace.setName(name);
    return trace;
  }

  void remove(ITrace2D trace) { chart.removeTrace(trace); }

  /** Sets the range of the x axis, whatever points the curves have. */
  void setXRange(double from, double to) {
    xRange = new Range(from, Math.max(to, from + 1));
    fitXTicks();
  }

  @Override
  public void doLayout() {
    super.doLayout();
    fitXTicks();
  }

  /** Has as many ticks as there is room for their numbers. */
  private void fitXTicks() {
    int digits = String.format(Locale.ROOT, "%,.0f", xRange.getMax()).length();
    int drawn = chart.getXChartEnd() - chart.getXChartStart(); // not known before the chart is painted
    int width = drawn > 0 ? Math.min(drawn, getWidth()) : getWidth() - USUAL_MARGIN;
    setRange(chart.getAxisX(), xRange.getMin(), xRange.getMax(),
        Math.min(Math.max(width / (DIGIT_PIXELS * digits + SPACE_PIXELS), LEAST_TICKS), MOST_X_TICKS));
  }

  void setYRange(double from, double to) {
    setRange(chart.getAxisY(), from, Math.max(to, from + 1), MOST_Y_TICKS);
  }

  /** Fits the y axis to the curves. It begins or ends at zero unless they stay far from that. */
  void fitY() { fitYFrom(-Double.MAX_VALUE); }

  /** Fits it to the newer half of the curves: those that fall fast at first are legible afterwards. */
  void fitYToNewerHalf() {
    List<ITrace2D> drawn = chart.getTraces().stream().filter(trace -> !trace.isEmpty()).toList();
    double first = drawn.stream().mapToDouble(ITrace2D::getMinX).min().orElse(0);
    double last = drawn.stream().mapToDouble(ITrace2D::getMaxX).max().orElse(0);
    fitYFrom((first + last) / 2);
  }

  private void fitYFrom(double x) {
    double low = Double.MAX_VALUE;
    double high = -Double.MAX_VALUE;
    for (ITrace2D trace : chart.getTraces()) {
      for (Iterator<ITracePoint2D> points = trace.iterator(); points.hasNext();) {
        ITracePoint2D point = points.next();
        if (point.getX() >= x) {
          low = Math.min(low, point.getY());
          high = Math.max(high, point.getY());
        }
      }
    }
    fitYTo(low, high);
  }

  private void fitYTo(double low, double high) {
    fitXTicks(); // the numbers beside the y axis may take more room than before
    if (low > high || (low == 0 && high == 0)) { // there is no point yet, or nothing but zero
      setRange(chart.getAxisY(), 0, 1, MOST_Y_TICKS);
      return;
    }
    boolean beginsAtZero = low > 0 && (low < 0.7 * high || low == high);
    boolean endsAtZero = high < 0 && (high > 0.7 * low || low == high);
    double from = beginsAtZero ? 0 : low;
    double to = endsAtZero ? 0 : high;
    int ticks = Math.min(Math.max(chart.getHeight() / TICK_PIXELS - 1, LEAST_TICKS), MOST_Y_TICKS);
    double step = FieldPainter.niceStep(Math.max(to - from, 1e-9 + 0.01 * Math.abs(to)), ticks);
    from = step * Math.floor(from / step);
    to = Math.max(step * Math.ceil(to / step), from + step);
    step = FieldPainter.niceStep(to - from, ticks); // the rounded range may need a larger one
    from = step * Math.floor(from / step + ROUNDING);
    to = Math.max(step * Math.ceil(to / step - ROUNDING), from + step);
    setRange(chart.getAxisY(), from - ROUNDING * step, to + ROUNDING * step, ticks);
  }

  private static void setRange(IAxis<?> axis, double from, double to, int ticks) {
    Range range = new Range(from, to);
    double step = FieldPainter.niceStep((to - from) * (1 - ROUNDING), ticks);
    if (axis.getRangePolicy() instanceof RangePolicyFixedViewport
        && range.equals(axis.getRangePolicy().getRange()) && step == axis.getMajorTickSpacing()) {
      return;
    }
    axis.setRangePolicy(new RangePolicyFixedViewport(range));
    axis.setMajorTickSpacing(step);
    axis.setMinorTickSpacing(step);
    axis.setFormatter(formatter(step));
  }

  void clear() { chart.getTraces().forEach(ITrace2D::removeAllPoints); }

  /** Frees the chart's thread. */
  void close() { chart.destroy(); }
}
